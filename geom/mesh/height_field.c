// Bodies below fields of heights.
//
// Each cell of the grid is divided by the diagonal from its corner [0, 0] to [1, 1]. With a base,
// the bottom is a polygon that has only the nodes of the border as vertices.
//
// Without a base, top and bottom meet where the height is 0. Edges whose ends have the height 0 cut
// the body: the triangle above and the one below meet there, and what is on the other side of such
// an edge is not connected. The cuts at a node of height 0 separate the triangles around it into
// fans, and each fan has a vertex of its own. A node without cuts has a vertex on the top and one on
// the bottom.

#include "geom/mesh/height_field.h"

#include "base/memory.h"
#include "base/stop.h"

// The six neighbors of a node that share an edge with it, counter-clockwise. Sector k is the
// triangle between the neighbors k and k + 1.
enum { SECTORS = 6 };
static const int NEIGHBORS[SECTORS][2] = {{1, 0}, {1, 1}, {0, 1}, {-1, 0}, {-1, -1}, {0, -1}};

typedef struct Builder {
  const CagHeightField *field;
  CagMesh *mesh;
  bool cuts;     // the bottom repeats the grid, and is cut where the height is 0
  size_t *first; // with cuts: the first vertex of each node
} Builder;

// Row j is counted from y = 0.
static double height_at(const CagHeightField *f, size_t i, size_t j) {
  return f->values[(f->rows - 1 - j) * f->columns + i];
}

static CagVec3 node_point(const CagHeightField *f, size_t i, size_t j) {
  return cag_vec3(f->size.x * ((double)i / (double)(f->columns - 1)),
                  f->size.y * ((double)j / (double)(f->rows - 1)), f->size.z * height_at(f, i, j));
}

static CagVec3 below(const CagHeightField *f, CagVec3 p) {
  return cag_vec3(p.x, p.y, f->base > 0 ? -f->base : 0);
}

// --- Nodes of height 0 ---

static bool is_neighbor(const CagHeightField *f, size_t i, size_t j, int k, size_t at[2]) {
  const long x = (long)i + NEIGHBORS[k][0], y = (long)j + NEIGHBORS[k][1];
  at[0] = (size_t)x;
  at[1] = (size_t)y;
  return x >= 0 && y >= 0 && x < (long)f->columns && y < (long)f->rows;
}

// Numbers the fans of a node of height 0: fan[k] is that of sector k, or -1 if it has no triangle.
// Returns the number of fans. At least one of the edges must be a cut.
static int number_fans(const CagHeightField *f, size_t i, size_t j, int fan[SECTORS]) {
  bool inside[SECTORS], low[SECTORS], cut[SECTORS];
  int first = -1, count = 0;
  for (int k = 0; k < SECTORS; k++) {
    size_t at[2];
    inside[k] = is_neighbor(f, i, j, k, at);
    low[k] = inside[k] && height_at(f, at[0], at[1]) == 0;
  }
  for (int k = 0; k < SECTORS; k++) {
    const int next = (k + 1) % SECTORS, last = (k + SECTORS - 1) % SECTORS;
    cut[k] = low[k] || !inside[k] || !inside[next] || !inside[last];
    if (cut[k] && first < 0) first = k;
  }
  for (int step = 0; first >= 0 && step < SECTORS; step++) {
    const int k = (first + step) % SECTORS, next = (k + 1) % SECTORS;
    const bool used = inside[k] && inside[next] && !(low[k] && low[next]);
    if (used && (cut[k] || count == 0)) count++;
    fan[k] = used ? count - 1 : -1;
  }
  return count;
}

static bool has_cut(const CagHeightField *f, size_t i, size_t j) {
  for (int k = 0; k < SECTORS; k++) {
    size_t at[2];
    if (!is_neighbor(f, i, j, k, at) || height_at(f, at[0], at[1]) == 0) return true;
  }
  return false;
}

// The number of vertices of a node of the cut grid.
static size_t vertices_of(const CagHeightField *f, size_t i, size_t j) {
  int fan[SECTORS];
  if (height_at(f, i, j) > 0 || !has_cut(f, i, j)) return 2;
  return (size_t)number_fans(f, i, j, fan);
}

// The vertex of a node for the triangle in a sector, above or below.
static size_t cut_vertex(const Builder *b, size_t i, size_t j, int sector, bool is_below) {
  const CagHeightField *f = b->field;
  const size_t first = b->first[j * f->columns + i];
  int fan[SECTORS];
  if (height_at(f, i, j) > 0 || !has_cut(f, i, j)) return first + is_below;
  number_fans(f, i, j, fan);
  return first + (size_t)fan[sector];
}

// --- Triangles ---

static void add_triangle(CagMesh *m, size_t a, size_t b, size_t c) {
  uint32_t *t = m->triangles + 3 * m->triangle_count++;
  t[0] = (uint32_t)a;
  t[1] = (uint32_t)b;
  t[2] = (uint32_t)c;
}

// A node with the sector in which a triangle sees it.
typedef struct Corner {
  size_t i, j;
  int sector;
} Corner;

// The triangles of a cell: 0 below the diagonal, and 1 above it.
static void cell_corners(size_t i, size_t j, int which, Corner out[3]) {
  out[0] = (Corner){i, j, which};
  out[1] = which ? (Corner){i + 1, j + 1, 3} : (Corner){i + 1, j, 2};
  out[2] = which ? (Corner){i, j + 1, 5} : (Corner){i + 1, j + 1, 4};
}

static bool is_flat(const CagHeightField *f, const Corner c[3]) {
  for (int k = 0; k < 3; k++)
    if (height_at(f, c[k].i, c[k].j) > 0) return false;
  return true;
}

static void add_cut_cell(Builder *b, size_t i, size_t j) {
  for (int which = 0; which < 2; which++) {
    Corner c[3];
    size_t v[2][3];
    cell_corners(i, j, which, c);
    if (is_flat(b->field, c)) continue;
    for (int side = 0; side < 2; side++)
      for (int k = 0; k < 3; k++) v[side][k] = cut_vertex(b, c[k].i, c[k].j, c[k].sector, side);
    add_triangle(b->mesh, v[0][0], v[0][1], v[0][2]);
    add_triangle(b->mesh, v[1][0], v[1][2], v[1][1]);
  }
}

// The wall between two corners of one triangle at the border, which is on the left of p and q. Ends
// of height 0 have one vertex above and below.
static void add_cut_wall(Builder *b, Corner p, Corner q) {
  const size_t high[2] = {cut_vertex(b, p.i, p.j, p.sector, false),
                          cut_vertex(b, q.i, q.j, q.sector, false)};
  const size_t low[2] = {cut_vertex(b, p.i, p.j, p.sector, true),
                         cut_vertex(b, q.i, q.j, q.sector, true)};
  if (height_at(b->field, p.i, p.j) > 0) add_triangle(b->mesh, low[0], high[1], high[0]);
  if (height_at(b->field, q.i, q.j) > 0) add_triangle(b->mesh, low[0], low[1], high[1]);
}

static void add_cut_walls(Builder *b) {
  const size_t n = b->field->columns - 1, m = b->field->rows - 1;
  for (size_t i = 0; i < n; i++) {
    add_cut_wall(b, (Corner){i, 0, 0}, (Corner){i + 1, 0, 2});
    add_cut_wall(b, (Corner){i + 1, m, 3}, (Corner){i, m, 5});
  }
  for (size_t j = 0; j < m; j++) {
    add_cut_wall(b, (Corner){n, j, 2}, (Corner){n, j + 1, 4});
    add_cut_wall(b, (Corner){0, j + 1, 5}, (Corner){0, j, 1});
  }
}

// The most triangles: two above and below in each cell, and two in each wall.
static size_t most_triangles(const CagHeightField *f) {
  const size_t n = f->columns - 1, m = f->rows - 1;
  return 4 * n * m + 4 * (n + m);
}

static CagStatus number_vertices(Builder *b, size_t *count, CagError *err) {
  const CagHeightField *f = b->field;
  b->first = cag_malloc(f->columns * f->rows * sizeof *b->first);
  if (!b->first) return cag_fail_memory(err);
  *count = 0;
  for (size_t j = 0; j < f->rows; j++) {
    if (cag_stop_check(err)) return err->status;
    for (size_t i = 0; i < f->columns; i++) {
      b->first[j * f->columns + i] = *count;
      *count += vertices_of(f, i, j);
    }
  }
  return CAG_OK;
}

static CagStatus fill_cut(Builder *b, CagError *err) {
  const CagHeightField *f = b->field;
  size_t count;
  CagStatus status = number_vertices(b, &count, err);
  if (!status) status = cag_mesh_new(count, most_triangles(f), false, false, false, &b->mesh, err);
  if (status) return status;
  b->mesh->triangle_count = 0;
  for (size_t j = 0; j < f->rows && !cag_stopped(); j++)
    for (size_t i = 0; i < f->columns; i++) {
      const size_t first = b->first[j * f->columns + i], n = vertices_of(f, i, j);
      const CagVec3 p = node_point(f, i, j);
      for (size_t k = 0; k < n; k++)
        b->mesh->positions[first + k] = k == 1 && p.z > 0 ? below(f, p) : p;
      if (i + 1 < f->columns && j + 1 < f->rows) add_cut_cell(b, i, j);
    }
  add_cut_walls(b);
  return cag_stop_check(err);
}

// --- With a base ---

// The vertex of the bottom at step k along the border, counter-clockwise from the origin.
static size_t border_vertex(const CagHeightField *f, size_t k) {
  const size_t around = 2 * (f->columns + f->rows - 2);
  return f->columns * f->rows + k % around;
}

static void border_node(const CagHeightField *f, size_t k, size_t *i, size_t *j) {
  const size_t n = f->columns - 1, m = f->rows - 1;
  k %= 2 * (n + m);
  *i = k <= n ? k : k <= n + m ? n : k <= 2 * n + m ? 2 * n + m - k : 0;
  *j = k <= n ? 0 : k <= n + m ? k - n : k <= 2 * n + m ? m : 2 * (n + m) - k;
}

static void add_base_walls(CagMesh *mesh, const CagHeightField *f) {
  const size_t around = 2 * (f->columns + f->rows - 2);
  for (size_t k = 0; k < around; k++) {
    size_t i, j, x, y;
    border_node(f, k, &i, &j);
    border_node(f, k + 1, &x, &y);
    mesh->positions[border_vertex(f, k)] = below(f, node_point(f, i, j));
    add_triangle(mesh, border_vertex(f, k), border_vertex(f, k + 1), y * f->columns + x);
    add_triangle(mesh, border_vertex(f, k), y * f->columns + x, j * f->columns + i);
  }
}

// Columns of the bottom are quadrilaterals, apart from the first and the last one, which have all
// nodes of their sides: fans, from the node next to the corner. If these are the same, it is a strip.
static void add_bottom(CagMesh *mesh, const CagHeightField *f) {
  const size_t n = f->columns - 1, m = f->rows - 1, around = 2 * (n + m);
  const size_t right = n, top = n + m, left = 2 * n + m; // steps of the corners
#define AT(k) border_vertex(f, k)
  if (n == 1) {
    for (size_t j = 0; j < m; j++) {
      add_triangle(mesh, AT(around - j), AT(right + j + 1), AT(right + j));
      add_triangle(mesh, AT(around - j), AT(around - j - 1), AT(right + j + 1));
    }
    return;
  }
  for (size_t j = 0; j < m; j++) {
    add_triangle(mesh, AT(1), AT(around - j), AT(around - j - 1));
    add_triangle(mesh, AT(right - 1), AT(right + j + 1), AT(right + j));
  }
  add_triangle(mesh, AT(1), AT(left), AT(left - 1));
  add_triangle(mesh, AT(right - 1), AT(top + 1), AT(top));
  for (size_t i = 1; i + 1 < n; i++) {
    add_triangle(mesh, AT(i), AT(left - i), AT(left - i - 1));
    add_triangle(mesh, AT(i), AT(left - i - 1), AT(i + 1));
  }
#undef AT
}

static CagStatus fill_on_base(Builder *b, CagError *err) {
  const CagHeightField *f = b->field;
  const size_t n = f->columns - 1, m = f->rows - 1, around = 2 * (n + m);
  const size_t bottom = n == 1 ? 2 * m : 2 * m + 2 + 2 * (n - 2);
  CagStatus status = cag_mesh_new(f->columns * f->rows + around, 2 * n * m + 2 * around + bottom,
                                  false, false, false, &b->mesh, err);
  if (status) return status;
  b->mesh->triangle_count = 0;
  for (size_t j = 0; j < f->rows && !cag_stopped(); j++)
    for (size_t i = 0; i < f->columns; i++) {
      const size_t at = j * f->columns + i;
      b->mesh->positions[at] = node_point(f, i, j);
      if (i == n || j == m) continue;
      add_triangle(b->mesh, at, at + 1, at + f->columns + 1);
      add_triangle(b->mesh, at, at + f->columns + 1, at + f->columns);
    }
  add_base_walls(b->mesh, f);
  add_bottom(b->mesh, f);
  return cag_stop_check(err);
}

CagStatus cag_mesh_height_field(const CagHeightField *f, CagMesh **out, CagError *err) {
  Builder b = {.field = f};
  CagStatus status = CAG_OK;
  for (size_t k = 0; f->base == 0 && k < f->columns * f->rows && !b.cuts; k++)
    b.cuts = f->values[k] == 0;
  status = b.cuts ? fill_cut(&b, err) : fill_on_base(&b, err);
  cag_free(b.first);
  if (status) cag_mesh_release(b.mesh);
  else *out = b.mesh;
  return status;
}
