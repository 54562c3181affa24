// Templates: small images that are searched in an image.

#include <math.h>

#include "geom/image/template.h"
#include "interp/builtin/image_calls.h"
#include "interp/vm/vm.h"

bool cag_templates_error_map(CagCall *call, const struct cag_templates_error_map *a,
                             CagValue *result) {
  CagRaster *out = NULL;
  CagStatus status = cag_template_errors(a->image, a->template, &out, call->err);
  return cag_raster_result(call, status, &out, result);
}

bool cag_templates_correlation_map(CagCall *call, const struct cag_templates_correlation_map *a,
                                   CagValue *result) {
  CagRaster *out = NULL;
  CagStatus status = cag_template_correlation(a->image, a->template, a->zero_mean, &out, call->err);
  return cag_raster_result(call, status, &out, result);
}

static CagValue match_at(CagVm *vm, const CagMatch *m) {
  return m->found ? cag_xy(vm, (double)m->x, (double)m->y) : cag_none();
}
static CagValue match_error(const CagMatch *m) {
  return m->found ? cag_number(m->error) : cag_none();
}

static CagValue match_value(CagVm *vm, const CagMatch *m) {
  static const char *const names[] = {"at", "error"};
  const CagValue values[] = {match_at(vm, m), match_error(m)};
  return cag_record_new(vm, names, values, 2);
}

bool cag_templates_find_template(CagCall *call, const struct cag_templates_find_template *a,
                                 CagValue *result) {
  const CagTemplatePart part = {.pattern = a->template};
  CagMatch m;
  if (!cag_geometry_ok(call, cag_template_find(a->image, &part, 1, &m, call->err))) return false;
  *result = match_value(call->vm, &m);
  return true;
}

bool cag_templates_recognize(CagCall *call, const struct cag_templates_recognize *a,
                             CagValue *result) {
  static const char *const names[] = {"name", "at", "error"};
  const CagLayout *layout = a->templates->layout;
  CagMatch best = {.error = INFINITY};
  const CagText *name = NULL;
  if (layout->count == 0) return cag_fail_value(call, 1, "at least one template");
  for (size_t i = 0; i < layout->count; i++) {
    const CagValue v = a->templates->fields[i];
    if (v.type != CAG_IMAGE)
      return cag_fail_call(call, 1, CAG_ERR_type, "expects images in `templates`, found %s as %s",
                           cag_type_article(v), layout->names[i]->bytes);
    const CagTemplatePart part = {.pattern = CAG_AS_IMAGE(v)->raster};
    CagMatch m;
    if (!cag_geometry_ok(call, cag_template_find(a->image, &part, 1, &m, call->err))) return false;
    if (!m.found || m.error >= best.error) continue;
    best = m;
    name = layout->names[i];
  }
  const bool known = name && best.error <= a->limit;
  const CagValue values[] = {known ? cag_text_new(call->vm, name->bytes, name->length)
                                   : cag_text_c(call->vm, "unknown"),
                             match_at(call->vm, &best), match_error(&best)};
  *result = cag_record_new(call->vm, names, values, 3);
  return true;
}

// --- Parts ---

// Reads an element of the list of parts: [template, [x, y]].
static bool read_part(CagCall *call, size_t i, CagValue v, CagTemplatePart *out) {
  const char *expected = "pairs of an image and an offset [x, y] in whole pixels";
  const double *offset;
  size_t n;
  if (v.type != CAG_LIST || CAG_AS_LIST(v)->length != 2)
    return cag_fail_element(call, 1, i, v, expected);
  const CagValue pattern = cag_list_get(call->vm, CAG_AS_LIST(v), 0);
  const CagValue at = cag_list_get(call->vm, CAG_AS_LIST(v), 1);
  if (pattern.type != CAG_IMAGE || !cag_as_vector(at, &offset, &n) || n != 2)
    return cag_fail_element(call, 1, i, v, expected);
  for (size_t k = 0; k < 2; k++)
    if (!(fabs(offset[k]) <= (double)CAG_RASTER_SIDE_MAX) || offset[k] != floor(offset[k]))
      return cag_fail_element(call, 1, i, v, expected);
  *out = (CagTemplatePart){CAG_AS_IMAGE(pattern)->raster, (long)offset[0], (long)offset[1]};
  return true;
}

bool cag_templates_find_parts(CagCall *call, const struct cag_templates_find_parts *a,
                              CagValue *result) {
  CagList *list;
  CagMatch m;
  if (!cag_arg_list(call, 1, &list)) return false;
  if (list->length == 0) return cag_fail_value(call, 1, "at least one part");
  CagTemplatePart *parts = cag_hold_array(call, list->length, sizeof *parts);
  for (size_t i = 0; i < list->length; i++)
    if (!read_part(call, i, cag_list_get(call->vm, list, i), &parts[i])) return false;
  if (!cag_geometry_ok(call, cag_template_find(a->image, parts, list->length, &m, call->err)))
    return false;
  *result = match_value(call->vm, &m);
  return true;
}

// --- Rotated templates ---

// The best rotated template so far.
typedef struct Search {
  CagCall *call;
  const CagRaster *image, *pattern;
  CagMatch match;
  double angle, scale;
  bool fits; // whether one of the templates is at most as large as the image
} Search;

static bool try_turned(Search *s, double angle, double scale) {
  CagCall *call = s->call;
  CagRaster *turned = NULL;
  CagMatch m = {0};
  CagStatus status = cag_template_turned(s->pattern, angle, scale, &turned, call->err);
  if (!status) {
    const CagTemplatePart part = {.pattern = turned};
    status = cag_template_find(s->image, &part, 1, &m, call->err);
  }
  cag_raster_release(turned);
  // Some of the templates may be too large.
  if (status && call->err->id == CAG_ERR_template_larger_than_image) return true;
  if (!cag_geometry_ok(call, status)) return false;
  s->fits = true;
  if (!m.found || m.counted == 0) return true;
  if (s->match.found && m.error / (double)m.counted >= s->match.error / (double)s->match.counted)
    return true;
  s->match = m;
  s->angle = angle;
  s->scale = scale;
  return true;
}

static bool try_scale(Search *s, const CagList *angles, double scale) {
  for (size_t i = 0; i < angles->length; i++) {
    const CagValue angle = cag_list_get(s->call->vm, angles, i);
    if (angle.type != CAG_ANGLE || !isfinite(angle.as.number))
      return cag_fail_element(s->call, 2, i, angle, "angles");
    if (!try_turned(s, angle.as.number, scale)) return false;
  }
  return true;
}

bool cag_templates_recognize_turned(CagCall *call, const struct cag_templates_recognize_turned *a,
                                    CagValue *result) {
  static const char *const names[] = {"angle", "scale", "at", "error"};
  Search s = {.call = call, .image = a->image, .pattern = a->template};
  const double one = 1, *scales = &one;
  size_t count = 1;
  CagList *angles;
  if (!cag_arg_list(call, 2, &angles) ||
      (cag_given(call, 3) && !cag_arg_numbers(call, 3, &scales, &count)))
    return false;
  if (angles->length == 0) return cag_fail_value(call, 2, "at least one angle");
  for (size_t i = 0; i < count; i++) {
    if (!(scales[i] > 0 && scales[i] < INFINITY))
      return cag_fail_element(call, 3, i, cag_number(scales[i]), "finite numbers greater than 0");
    if (!try_scale(&s, angles, scales[i])) return false;
  }
  if (!s.fits)
    return cag_fail_call(call, 1, CAG_ERR_template_larger_than_image,
                         "expects a template that is at most as large as the image in at least one "
                         "of the rotations and scales");
  const bool found = s.match.found;
  const CagValue values[] = {found ? cag_angle(s.angle) : cag_none(),
                             found ? cag_number(s.scale) : cag_none(), match_at(call->vm, &s.match),
                             match_error(&s.match)};
  *result = cag_record_new(call->vm, names, values, 4);
  return true;
}
