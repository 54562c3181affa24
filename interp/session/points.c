// The points of a part for programs that show them and let them be dragged.

#include "interp/session/points.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/clock.h"
#include "base/memory.h"
#include "lang/lexer.h"

// Of the points that cannot be moved, at most these are given.
enum { MOST_LOCKED = 100 };
// Seconds for trying out params.
#define TRIAL_TIME 1.0
// A param is changed by this part of its range to find out which points it moves.
#define TRIAL_STEP 1e-3
// A point has moved if a coordinate did by this part of its largest one, or of 1 mm.
#define MOVED 1e-9

typedef struct FoundPoint {
  CagPointView view;
  char why[120];
  bool computed; // a coordinate is not a number in the script
  size_t row;    // in moved_by
} FoundPoint;

typedef struct CagSessionPoints {
  FoundPoint *items;
  size_t count;
  size_t omitted;
  bool *moved_by; // a row for each point, with the params in order
  CagTrialParam *params;
  size_t param_count;
} CagSessionPoints;

void cag_session_drop_points(CagSession *s) {
  if (!s->points) return;
  cag_free(s->points->items);
  cag_free(s->points->moved_by);
  cag_free(s->points->params);
  cag_free(s->points);
  s->points = NULL;
}

// --- Numbers in the script ---

// Splits the text of a number into value and unit.
static void read_unit(const CagSource *source, CagSpan span, CagPointNumber *out) {
  char text[64];
  size_t n = 0;
  for (uint32_t i = span.start; i < span.end && n + 1 < sizeof text; i++)
    if (source->text[i] != '_' && source->text[i] != ' ') text[n++] = source->text[i];
  text[n] = 0;
  while (n > 0 && text[n - 1] >= 'a' && text[n - 1] <= 'z') n--;
  snprintf(out->unit, sizeof out->unit, "%.7s", text + n);
  out->scale = out->unit[0] ? cag_lexer_unit_length(out->unit) : 1;
}

static bool read_number(CagLiteral l, double value, CagPointNumber *out) {
  CagSpan span;
  double written;
  if (!l.expr || !cag_literal_is_number(l, &span, &written)) return false;
  // The run has used another value: the text was not found where the value comes from.
  if (written != value || l.module->source->library) return false;
  *out = (CagPointNumber){
      .literal = true, .place = cag_session_place(l.module->source, span), .value = value};
  read_unit(l.module->source, span, out);
  return out->scale > 0;
}

// Finds the numbers of a point in the script. Returns how many there are.
static int read_numbers(const CagVm *vm, const CagPointSpot *spot, CagPointView *out) {
  CagLiteral items[3];
  const size_t n = (size_t)spot->dimension;
  int found = 0;
  cag_literal_elements(vm, spot->literal, n, items);
  for (size_t k = 0; k < n; k++)
    if (read_number(items[k], spot->values[k], &out->numbers[k])) found++;
  return found;
}

// Why no coordinate of a point is a number in the script.
static void tell_why(const CagPointSpot *spot, FoundPoint *p) {
  const CagExpr *e = spot->literal.expr;
  const CagSource *source = e ? spot->literal.module->source : spot->step->site->source;
  if (spot->step->site->source->library || source->library) {
    snprintf(p->why, sizeof p->why, "made by a function of the standard library");
  } else if (!e) {
    snprintf(p->why, sizeof p->why, "computed by the script, without a param that has a range");
  } else {
    const size_t length = e->span.end - e->span.start, most = 40;
    const char *text = source->text + e->span.start;
    size_t n = 0;
    while (n < length && n < most && text[n] != '\n') n++;
    while (n > 0 && n < length && (text[n] & 0xc0) == 0x80) n--; // not within a character
    snprintf(p->why, sizeof p->why, "computed from `%.*s%s`, without a param that has a range",
             (int)n, text, n < length ? " ..." : "");
  }
}

// --- Points ---

static void copy_map(const CagTransform *t, double out[3][4]) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 4; j++) out[i][j] = t->m[i][j] / t->m[3][3];
}

static void read_point(const CagVm *vm, const CagPointSpot *spot, size_t id, FoundPoint *p) {
  const CagVec3 at = cag_point_spot_at(spot);
  p->view = (CagPointView){
      .id = id, .call = spot->function, .dimension = spot->dimension, .at = {at.x, at.y, at.z}};
  const int found = read_numbers(vm, spot, &p->view);
  p->computed = found < spot->dimension;
  if (found == 0) tell_why(spot, p);
  if (!cag_transform_is_affine(&spot->map)) {
    snprintf(p->why, sizeof p->why, "moved by a perspective");
    for (int k = 0; k < 3; k++) p->view.numbers[k].literal = false;
    p->computed = false;
  } else {
    copy_map(&spot->map, p->view.map);
  }
}

// --- Params that move points ---

// Finds the coordinates in the script that differ; a later call may move all points of the part
// alike.
static bool find_moved(const CagPointSpot *a, const CagPointSpot *b, bool moved[3]) {
  double size = 1;
  bool any = false;
  if (a->dimension != b->dimension) return false;
  for (int k = 0; k < a->dimension; k++) size = fmax(size, fabs(a->values[k]));
  for (int k = 0; k < a->dimension; k++) {
    const double d = fabs(a->values[k] - b->values[k]);
    if (!(isfinite(d) && d > MOVED * size)) continue;
    any = moved[k] = true;
  }
  return any;
}

static void note_moved(CagSessionPoints *points, const CagPointWork *f, size_t param) {
  if (f->spots.count != f->moved.count) return; // points are not the same ones any more
  for (size_t i = 0; i < points->count; i++) {
    FoundPoint *p = &points->items[i];
    const size_t id = p->view.id;
    const bool moved =
        p->computed && find_moved(&f->spots.items[id], &f->moved.items[id], p->view.moved);
    points->moved_by[i * points->param_count + param] = moved;
    if (moved) p->view.param_count++;
  }
}

static void try_params(CagPointWork *f, CagSessionPoints *points) {
  const double begin = cag_clock_seconds();
  cag_trial_begin(&f->trial, f->session, f->part);
  for (size_t k = 0; k < points->param_count; k++) {
    CagTrialParam p = points->params[k];
    const double step = TRIAL_STEP * (p.high - p.low);
    if (cag_clock_seconds() - begin > TRIAL_TIME) break;
    p.value += p.value + step <= p.high ? step : -step;
    if (cag_trial_spots(&f->trial, &p, 1, &f->moved)) note_moved(points, f, k);
  }
  cag_trial_end(&f->trial);
}

static void list_trial_params(const CagSession *s, CagSessionPoints *points) {
  CagTrialParam p;
  size_t n = 0;
  while (cag_trial_param(s, n, &p)) n++;
  points->params = cag_checked(cag_calloc(n + 1, sizeof p));
  points->moved_by = cag_checked(cag_calloc(n * points->count + 1, sizeof *points->moved_by));
  points->param_count = n;
  for (size_t k = 0; k < n; k++) cag_trial_param(s, k, &points->params[k]);
}

// --- Finding ---

static bool is_locked(const FoundPoint *p) {
  for (int k = 0; k < p->view.dimension; k++)
    if (p->view.numbers[k].literal) return false;
  return p->view.param_count == 0;
}

// Keeps as many points as are given, those that can be moved first, in their order.
static void choose_points(CagSessionPoints *points) {
  size_t movable = 0, kept = 0;
  for (size_t i = 0; i < points->count; i++) movable += !is_locked(&points->items[i]);
  size_t locked = movable < CAG_POINTS_MAX ? CAG_POINTS_MAX - movable : 0;
  if (locked > MOST_LOCKED) locked = MOST_LOCKED;
  for (size_t i = 0; i < points->count; i++) {
    FoundPoint p = points->items[i];
    if (is_locked(&p) ? locked == 0 : kept + locked >= CAG_POINTS_MAX) continue;
    if (is_locked(&p)) locked--;
    p.row = i;
    points->items[kept++] = p;
  }
  points->omitted = points->count - kept;
  points->count = kept;
}

static bool find_points(CagVm *vm, void *context) {
  CagPointWork *f = context;
  CagSession *s = f->session;
  const CagItemSource *source = &s->sources.items[s->scene.items[f->part].number];
  bool computed = false;
  CagSessionPoints *points = s->points = cag_checked(cag_calloc(1, sizeof *s->points));
  cag_point_spots(vm, source->shape, true, &f->spots);
  points->items = cag_checked(cag_calloc(f->spots.count + 1, sizeof *points->items));
  for (size_t i = 0; i < f->spots.count; i++) {
    const CagVec3 at = cag_point_spot_at(&f->spots.items[i]);
    if (!isfinite(at.x + at.y + at.z)) continue;
    FoundPoint *p = &points->items[points->count++];
    read_point(vm, &f->spots.items[i], i, p);
    computed = computed || p->computed;
  }
  list_trial_params(s, points);
  if (computed && points->param_count > 0) try_params(f, points);
  choose_points(points);
  return true;
}

bool cag_points_of_part(const CagSession *s, size_t part) {
  if (!s->has_scene || part >= s->scene.item_count) return false;
  const CagItem *item = &s->scene.items[part];
  const size_t number = item->number;
  return item->kind != CAG_ITEM_GROUND && number < s->sources.count &&
         s->sources.items[number].shape;
}

int cag_points_work(CagSession *s, bool (*work)(CagVm *vm, void *context), CagPointWork *w,
                    void *context) {
  cag_session_renew_time(s);
  const int status = cag_session_work(s, work, context);
  CagAccount *before = cag_account_lend(&s->vm->account);
  cag_free(w->spots.items);
  cag_free(w->moved.items);
  cag_account_lend(before);
  return status;
}

int cag_session_points(CagSession *s, size_t part, size_t *count, size_t *omitted) {
  CagPointWork f = {.session = s, .part = part};
  *count = *omitted = 0;
  if (!cag_session_begin(s)) return CAG_STATUS_USAGE;
  cag_session_drop_points(s);
  int status = CAG_STATUS_USAGE;
  if (cag_points_of_part(s, part) && cag_session_list_params(s))
    status = cag_points_work(s, find_points, &f, &f);
  if (status != CAG_STATUS_OK) {
    cag_session_drop_points(s);
  } else {
    *count = s->points->count;
    *omitted = s->points->omitted;
  }
  return cag_session_end(s, status);
}

bool cag_session_point(CagSession *s, size_t i, CagPointView *out) {
  *out = (CagPointView){0};
  if (!s->points || i >= s->points->count) return false;
  *out = s->points->items[i].view;
  if (is_locked(&s->points->items[i])) out->locked = s->points->items[i].why;
  return true;
}

const char *cag_session_point_param(CagSession *s, size_t i, size_t k) {
  if (!s->points || i >= s->points->count) return NULL;
  const CagSessionPoints *points = s->points;
  const bool *moved_by = points->moved_by + points->items[i].row * points->param_count;
  for (size_t j = 0; j < points->param_count; j++)
    if (moved_by[j] && k-- == 0) return points->params[j].name;
  return NULL;
}
