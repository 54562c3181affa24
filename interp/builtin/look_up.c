// Values from a table of pairs.

#include "geom/curve/graph_spline.h"
#include "interp/builtin/shapes.h"
#include "interp/builtin/support.h"

// Columns of the table: the keys, and the coordinates of the values in turn.
typedef struct Table {
  size_t rows, columns; // columns: of the values; 0: they are numbers
  double *keys, *values;
} Table;

// Reads the value of one pair, a number or a vector of as many numbers as that of the first pair.
static bool read_value(CagCall *call, CagValue v, size_t row, Table *t) {
  const double *x = &v.as.number;
  size_t n = 0;
  if (v.type != CAG_NUMBER && !cag_as_vector(v, &x, &n))
    return cag_fail_element(call, 1, row, v, "numbers or vectors as the second of each pair");
  if (row == 0) {
    t->columns = n;
    t->values = cag_hold_array(call, t->rows * (n ? n : 1), sizeof *t->values);
  }
  if (n != t->columns)
    return cag_fail_element(call, 1, row, v, "values with as many numbers as the first has");
  const size_t size = n ? n : 1;
  for (size_t i = 0; i < size; i++) {
    t->values[row * size + i] = x[i];
    if (!isfinite(x[i])) return cag_fail_element(call, 1, row, v, "finite numbers");
  }
  return true;
}

static bool read_pair(CagCall *call, CagValue pair, size_t row, Table *t) {
  CagValue key = cag_unset();
  const CagList *list = pair.type == CAG_LIST ? CAG_AS_LIST(pair) : NULL;
  if (list && list->length == 2) key = cag_list_get(call->vm, list, 0);
  if (key.type != CAG_NUMBER || !isfinite(key.as.number))
    return cag_fail_element(call, 1, row, pair, "pairs [x, y] with numbers x");
  t->keys[row] = key.as.number;
  if (row > 0 && !(t->keys[row] > t->keys[row - 1]))
    return cag_fail_element(call, 1, row, key, "pairs with increasing x");
  return read_value(call, cag_list_get(call->vm, list, 1), row, t);
}

static bool read_table(CagCall *call, Table *t) {
  CagList *list;
  if (!cag_arg_list(call, 1, &list)) return false;
  *t = (Table){.rows = list->length};
  if (t->rows == 0) return cag_fail_value(call, 1, "at least one pair [x, y]");
  t->keys = cag_hold_array(call, t->rows, sizeof *t->keys);
  for (size_t i = 0; i < t->rows; i++) {
    if (!cag_keep_going(call->vm) || !read_pair(call, cag_list_get(call->vm, list, i), i, t))
      return false;
  }
  return true;
}

// The last row whose key is at most x; x is not before the first key.
static size_t row_before(const Table *t, double x) {
  size_t low = 0, high = t->rows;
  while (high - low > 1) {
    const size_t middle = low + (high - low) / 2;
    if (t->keys[middle] <= x) low = middle;
    else high = middle;
  }
  return low;
}

// The cubic between two rows with these slopes, at the fraction s.
static double cubic(double h, double s, double p, double q, double dp, double dq) {
  const double r = 1 - s;
  return r * r * ((1 + 2 * s) * p + s * h * dp) + s * s * ((1 + 2 * r) * q - r * h * dq);
}

enum { LINEAR, STEP, PCHIP };

// Slopes depend on at most two rows on each side.
static bool pchip_value(CagCall *call, const Table *t, size_t row, size_t column, double x,
                        double *out) {
  const size_t size = t->columns ? t->columns : 1;
  const size_t first = row > 1 ? row - 1 : 0;
  const size_t last = row + 3 < t->rows ? row + 3 : t->rows;
  double keys[4], values[4], slopes[4];
  size_t n = 0;
  for (size_t i = first; i < last && n < 4; i++, n++) {
    keys[n] = t->keys[i];
    values[n] = t->values[i * size + column];
  }
  if (!cag_geometry_ok(call, cag_pchip_slopes(keys, values, n, slopes, call->err))) return false;
  const size_t i = row - first;
  const double h = keys[i + 1] - keys[i];
  *out = cubic(h, (x - keys[i]) / h, values[i], values[i + 1], slopes[i], slopes[i + 1]);
  return true;
}

bool cag_calculus_look_up(CagCall *call, const struct cag_calculus_look_up *a, CagValue *result) {
  Table t;
  if (!read_table(call, &t)) return false;
  const size_t size = t.columns ? t.columns : 1;
  const size_t row = a->x <= t.keys[0] ? 0 : row_before(&t, a->x);
  const bool exact = a->kind == STEP || a->x <= t.keys[0] || row + 1 == t.rows;
  double *y = cag_hold_array(call, size, sizeof *y);
  for (size_t i = 0; i < size; i++) {
    const double from = t.values[row * size + i];
    y[i] = from;
    if (exact) continue;
    const double share = (a->x - t.keys[row]) / (t.keys[row + 1] - t.keys[row]);
    if (a->kind == LINEAR) y[i] = cag_mix_numbers(from, t.values[(row + 1) * size + i], share);
    else if (!pchip_value(call, &t, row, i, a->x, &y[i])) return false;
  }
  *result = t.columns ? cag_vector(call->vm, y, size) : cag_number(y[0]);
  return true;
}
