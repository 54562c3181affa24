// The table of all built-ins.
//
// cag_builtins holds the rows of all families, which tools/rows.awk generates from
// interp/builtin/*.rows. This file groups the rows by name and parses their signatures. Both happen
// once, when the table is first used. The table does not change afterwards, so any number of
// machines may share it. Names are in the order of their first rows.

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "base/arena.h"
#include "base/hash.h"
#include "interp/builtin/support.h"
#include "interp/vm/jet_builtins.h"
#include "interp/vm/signature.h"

// --- Constants ---

static CagValue make_identity(CagVm *vm) {
  CagTransform t = cag_transform_identity();
  return cag_transform_value(vm, &t);
}

static CagValue make_constant(CagVm *vm, const char *name) {
  static const struct {
    const char *name;
    double point[3];
  } points[] = {{"X", {1, 0, 0}}, {"Y", {0, 1, 0}}, {"Z", {0, 0, 1}}, {"origin", {0, 0, 0}}};
  static const struct {
    const char *name;
    CagType type;
    double value;
  } numbers[] = {{"pi", CAG_NUMBER, 3.141592653589793}, {"tau", CAG_NUMBER, 6.283185307179586},
                 {"inf", CAG_NUMBER, HUGE_VAL},         {"deg", CAG_ANGLE, 1},
                 {"rad", CAG_ANGLE, 57.29577951308232}, {"turn", CAG_ANGLE, 360}};
  for (size_t i = 0; i < sizeof points / sizeof *points; i++)
    if (strcmp(name, points[i].name) == 0) return cag_vector(vm, points[i].point, 3);
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
    if (strcmp(name, numbers[i].name) == 0)
      return (CagValue){numbers[i].type, {.number = numbers[i].value}};
  return strcmp(name, "identity") == 0 ? make_identity(vm) : cag_unset();
}

// --- The gathered table ---

typedef struct Name {
  const char *name;
  size_t first, count; // its rows
  size_t jet;          // row of its differentiated form (jets.h)
} Name;

typedef struct Table {
  size_t row_count, name_count;
  CagBuiltin *rows;         // grouped by name
  CagSignature *signatures; // of the rows
  Name *names;
  const char **name_texts;
  CagHashIndex index; // of names
} Table;

// Built once per process at the first use, and never freed. If memory runs out, the table stays
// empty, and the next use tries again.
static Table table;
static CagArena table_arena;
static atomic_bool table_ready;
static pthread_mutex_t table_mutex = PTHREAD_MUTEX_INITIALIZER;

static void *table_alloc(size_t n, size_t size) { return cag_arena_alloc(&table_arena, n * size); }

// --- Building ---

static size_t find_name(const char *name) {
  size_t i;
  CagHashWalk w = cag_hash_walk(&table.index, cag_hash_text(CAG_HASH_START, name));
  while (cag_hash_next(&w, &i))
    if (strcmp(table.names[i].name, name) == 0) return i;
  return (size_t)-1;
}

// Numbers the names in the order of their first rows, and counts the rows of each.
static size_t *number_names(CagSignature *signatures) {
  size_t *name_of = table_alloc(table.row_count, sizeof *name_of);
  for (size_t r = 0; r < table.row_count; r++) {
    const char *name = signatures[r].name;
    name_of[r] = find_name(name);
    if (name_of[r] == (size_t)-1) {
      name_of[r] = table.name_count++;
      table.names[name_of[r]].name = name;
      if (!cag_hash_add(&table.index, cag_hash_text(CAG_HASH_START, name), name_of[r]))
        cag_memory_leave();
    }
    table.names[name_of[r]].count++;
  }
  return name_of;
}

static void build_table(void *context) {
  (void)context;
  while (cag_builtins[table.row_count].signature) table.row_count++;
  CagSignature *parsed = table_alloc(table.row_count, sizeof *parsed);
  for (size_t r = 0; r < table.row_count; r++)
    cag_signature_parse(&parsed[r], cag_builtins[r].signature, &table_arena);
  table.names = table_alloc(table.row_count, sizeof *table.names);
  size_t *name_of = number_names(parsed);
  // Group by name.
  table.name_texts = table_alloc(table.name_count + 1, sizeof *table.name_texts);
  size_t first = 0;
  for (size_t i = 0; i < table.name_count; i++) {
    table.name_texts[i] = table.names[i].name;
    table.names[i].first = first;
    table.names[i].jet = cag_jet_row(table.names[i].name);
    first += table.names[i].count;
  }
  table.rows = table_alloc(table.row_count, sizeof *table.rows);
  table.signatures = table_alloc(table.row_count, sizeof *table.signatures);
  size_t *filled = table_alloc(table.name_count, sizeof *filled);
  for (size_t r = 0; r < table.row_count; r++) {
    size_t to = table.names[name_of[r]].first + filled[name_of[r]]++;
    table.rows[to] = cag_builtins[r];
    table.rows[to].signature = parsed[r].text;
    table.signatures[to] = parsed[r];
  }
}

bool cag_builtins_ready(void) {
  if (table_ready) return true;
  pthread_mutex_lock(&table_mutex);
  if (!table_ready && cag_memory_guard(build_table, NULL)) table_ready = true;
  if (!table_ready) {
    cag_arena_free(&table_arena);
    cag_hash_free(&table.index);
    table = (Table){0};
  }
  pthread_mutex_unlock(&table_mutex);
  return table_ready;
}

// --- Questions ---

size_t cag_builtin_count(void) { return cag_builtins_ready() ? table.name_count : 0; }

size_t cag_builtin_find(const char *name) {
  return cag_builtins_ready() ? find_name(name) : (size_t)-1;
}

size_t cag_builtin_jet(size_t index) { return table.names[index].jet; }

const char *cag_builtin_name(size_t index) { return table.names[index].name; }

const CagBuiltin *cag_builtin_rows(size_t index, size_t *rows) {
  const Name *name = &table.names[index];
  *rows = name->count;
  return table.rows + name->first;
}

const char *const *cag_builtin_names(void) {
  static const char *const none[] = {NULL};
  return cag_builtins_ready() ? table.name_texts : none;
}

const CagSignature *cag_builtin_signature(size_t index, size_t row) {
  size_t at = table.names[index].first + row;
  return table.rows[at].function ? &table.signatures[at] : NULL;
}

const CagSignature *cag_builtin_signature_of(const CagBuiltin *row) {
  return row->function ? &table.signatures[row - table.rows] : NULL;
}

static bool row_serves(size_t at, CagType first) {
  uint64_t mask = table.rows[at].first;
  return mask == 0 || first == CAG_UNSET || (mask >> first & 1) != 0;
}

size_t cag_builtin_select(size_t index, CagType first, size_t positional) {
  const Name *name = &table.names[index];
  size_t found = (size_t)-1;
  for (size_t row = 0; row < name->count; row++) {
    if (!row_serves(name->first + row, first)) continue;
    const CagSignature *s = &table.signatures[name->first + row];
    if (positional <= s->count || s->variadic) return row;
    if (found == (size_t)-1) found = row;
  }
  return found;
}

void cag_builtin_served(size_t index, CagString *out) {
  static const char *const articles[] = {
#define X(tag, name, article) article,
      CAG_VALUE_TYPES(X)
#undef X
  };
  const Name *name = &table.names[index];
  uint64_t mask = 0;
  for (size_t row = 0; row < name->count; row++) mask |= table.rows[name->first + row].first;
  // A closure and a built-in are both called a function, so one of the two tags is enough.
  if (mask & CAG_TYPE_BIT(CLOSURE)) mask &= ~CAG_TYPE_BIT(BUILTIN);
  bool any = false;
  for (size_t type = 0; mask >> type != 0 && type < CAG_TYPE_COUNT; type++) {
    if ((mask >> type & 1) == 0) continue;
    bool last = mask >> type == 1;
    const char *between = !any ? "" : last ? " or " : ", ";
    cag_string_printf(out, "%s%s", between, articles[type]);
    any = true;
  }
  if (!any) cag_string_add(out, "any value", strlen("any value"));
}

CagValue cag_builtin_constant(CagVm *vm, size_t index) {
  const Name *name = &table.names[index];
  return table.rows[name->first].function ? cag_unset() : make_constant(vm, name->name);
}
