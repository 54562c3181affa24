// Detection of parts that are copies of each other.

#include "mesh_write_support.h"

// A mesh that visibly differs from a moved one is not a copy of it. A mesh that differs by
// rounding, or in the diagonal of a quad, is.
static void copies_differ_in_nothing_that_is_seen(void **state) {
  (void)state;
  seed = 7;
  CagTransform move, turn;
  OK(cag_rotate(cag_vec3(1, 2, 3), 1.25, cag_vec3(0, 5, 0), &turn, &err));
  move = cag_translate(cag_vec3(100, -20, 3));
  move = cag_transform_multiply(&move, &turn);
  static const struct {
    const char *what;
    bool copy;
  } changes[] = {{"nothing", true},
                 {"a position", false},
                 {"a position, by rounding", true},
                 {"a normal", false},
                 {"a normal, by little", true},
                 {"a parameter", false},
                 {"a parameter below", false},
                 {"a parameter, by little", true},
                 {"a large parameter, by little", true},
                 {"weld", false},
                 {"the scale", false},
                 {"its end", false},
                 {"its begin", false},
                 {"stripes", false},
                 {"the last triangle", false},
                 {"a turned triangle", true},
                 {"a reversed triangle", false},
                 {"a diagonal", true},
                 {"no quad", false},
                 {"normals left out", false},
                 {"parameters left out", false},
                 {"weld left out", false},
                 {"another count", false}};
  for (size_t k = 0; k < sizeof changes / sizeof *changes; k++)
    for (int moved = 0; moved < 3; moved++) {
      CagMesh *a = random_mesh(30, 12, 7, false), *b;
      const uint32_t quad[6] = {3, 7, 8, 3, 8, 9}, other[6] = {3, 7, 9, 7, 8, 9};
      memcpy(a->triangles + 6, quad, sizeof quad);
      a->uv[2 * 5] = 1e6;
      a->scale = (CagColorScale){CAG_SCALE_SEQUENCE, 0, 1, 3};
      const CagTransform unit = cag_transform_identity(),
                         shift = cag_translate(cag_vec3(1e3, 0, 7));
      const CagTransform *t = moved == 0 ? &unit : moved == 1 ? &shift : &move;
      if (k < 19) OK(cag_mesh_transform(a, t, &b, &err));
      else {
        OK(cag_mesh_new(k == 22 ? 31 : 30, 12, k != 19, k != 20, k != 21, &b, &err));
        for (size_t v = 0; v < 30; v++) b->positions[v] = cag_transform_point(t, a->positions[v]);
        memcpy(b->triangles, a->triangles, 36 * sizeof *a->triangles);
        if (k != 19)
          for (size_t v = 0; v < 30; v++) b->normals[v] = cag_transform_vector(t, a->normals[v]);
        if (k != 20) memcpy(b->uv, a->uv, 60 * sizeof *a->uv);
        if (k != 21) memcpy(b->weld, a->weld, 30 * sizeof *a->weld);
        if (k == 22)
          b->positions[30] = b->positions[0], b->weld[30] = 0, b->normals[30] = b->normals[0],
          b->uv[60] = b->uv[61] = 0;
      }
      b->scale = a->scale;
      uint32_t *last = b->triangles + 33;
      switch (k) {
      case 1: b->positions[20].y += 1e-3; break;
      case 2: b->positions[20].y += 1e-8; break;
      case 3: b->normals[20] = random_unit(); break;
      case 4: b->normals[20].z += 5e-7; break;
      case 5: b->uv[41] += 1e-3; break;
      case 6: b->uv[40] -= 1e-3; break;
      case 7: b->uv[40] += 5e-7; break;
      case 8: b->uv[10] += 0.5; break;
      case 9: b->weld[29] = b->weld[29] == 29 ? 0 : 29; break;
      case 10: b->scale.kind = CAG_SCALE_DIVERGING; break;
      case 11: b->scale.to = 2; break;
      case 12: b->scale.from = -1; break;
      case 13: b->scale.stripes = 4; break;
      case 14: last[2] = last[2] == 29 ? 28 : 29; break;
      case 15: {
        const uint32_t first = last[0];
        last[0] = last[1], last[1] = last[2], last[2] = first;
        break;
      }
      case 16: {
        const uint32_t first = last[0];
        last[0] = last[1], last[1] = first;
        break;
      }
      case 17: memcpy(b->triangles + 6, other, sizeof other); break;
      case 18: memcpy(b->triangles + 6, other, sizeof other), b->triangles[11] = 10; break;
      default: break;
      }
      const CagMeshPart parts[] = {{"a", a, NULL}, {"b", b, NULL}};
      CagMeshCopy *copies;
      OK(cag_mesh_find_copies(parts, 2, false, &copies, &err));
      assert_int_equal(copies[0].original, 0);
      if ((copies[1].original == 0) != changes[k].copy) fail_msg("%s (%d)", changes[k].what, moved);
      for (int i = 0; i < 4 && changes[k].copy; i++)
        for (int j = 0; j < 4; j++) {
          const double off = fabs(copies[1].place.m[i][j] - t->m[i][j]);
          // A copy that is only translated has exactly no rotation.
          if (off > (j == 3 ? 1e-6 : moved < 2 ? 0 : 1e-9))
            fail_msg("%s: [%d][%d]", changes[k].what, i, j);
        }
      free(copies);
      cag_mesh_release(a);
      cag_mesh_release(b);
    }
}

// Many parts of few shapes: each is a copy of the first part of its shape.
static void each_part_is_a_copy_of_the_first_of_its_shape(void **state) {
  (void)state;
  enum { N = 60, SHAPES = 7 };
  seed = 8;
  CagMesh *shapes[SHAPES], *meshes[N];
  CagMeshPart parts[N];
  static char names[2][2] = {"a", "b"};
  CagMaterial materials[2] = {{.name = names[0]}, {.name = names[1]}};
  size_t first[SHAPES][2], shape[N];
  for (size_t k = 0; k < SHAPES; k++) {
    shapes[k] = random_mesh(20, 10, 7, false); // all with the same counts
    first[k][0] = first[k][1] = SIZE_MAX;
  }
  for (size_t i = 0; i < N; i++) {
    CagTransform t;
    shape[i] = below(SHAPES);
    const double angle = uniform(-4, 4);
    OK(cag_rotate(random_unit(), angle, cag_vec3(1, 2, 3), &t, &err));
    OK(cag_mesh_transform(shapes[shape[i]], &t, &meshes[i], &err));
    parts[i] = (CagMeshPart){"p", meshes[i], &materials[below(2)]};
  }
  for (int same = 0; same < 2; same++) {
    CagMeshCopy *copies;
    OK(cag_mesh_find_copies(parts, N, same, &copies, &err));
    for (size_t k = 0; k < SHAPES; k++) first[k][0] = first[k][1] = SIZE_MAX;
    for (size_t i = 0; i < N; i++) {
      size_t *f = &first[shape[i]][same && parts[i].material == &materials[1]];
      if (*f == SIZE_MAX) *f = i;
      assert_int_equal(copies[i].original, *f);
      for (size_t v = 0; v < 20; v++)
        assert_true(distance(cag_transform_point(&copies[i].place, meshes[*f]->positions[v]),
                             meshes[i]->positions[v]) < 1e-8);
    }
    free(copies);
  }
  for (size_t k = 0; k < SHAPES; k++) cag_mesh_release(shapes[k]);
  for (size_t i = 0; i < N; i++) cag_mesh_release(meshes[i]);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(copies_differ_in_nothing_that_is_seen),
      cmocka_unit_test(each_part_is_a_copy_of_the_first_of_its_shape),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
