// Written 3MF files, compared with the meshes, materials, and scales of the scene.

#include "mesh_write_support.h"

// The third member of the archive, unpacked. The directory must have the same data about each
// member.
static char *model_of(const char *b, size_t size) {
  char *out = NULL;
  const char *at = b, *end = b + size - 22;
  assert_memory_equal(end, "PK\5\6", 4);
  const char *entry = b + word_at(end + 16);
  for (int k = 0; k < 3; k++) {
    assert_memory_equal(at, "PK\3\4", 4);
    assert_memory_equal(entry, "PK\1\2", 4);
    const size_t name = (unsigned char)at[26];
    assert_memory_equal(at + 14, entry + 16, 12);
    assert_memory_equal(at + 30, entry + 46, name);
    assert_int_equal(word_at(entry + 42), at - b);
    const uint32_t packed = word_at(at + 18), whole = word_at(at + 22);
    free(out);
    out = calloc(1, whole + 1);
    z_stream z = {.next_in = (Bytef *)at + 30 + name,
                  .avail_in = packed,
                  .next_out = (Bytef *)out,
                  .avail_out = whole};
    assert_int_equal(inflateInit2(&z, -15), Z_OK);
    assert_int_equal(inflate(&z, Z_FINISH), Z_STREAM_END);
    assert_int_equal(z.total_out, whole);
    inflateEnd(&z);
    assert_int_equal(crc32(0, (Bytef *)out, whole), word_at(at + 14));
    at += 30 + name + packed;
    entry += 46 + name;
  }
  assert_ptr_equal(at, b + word_at(end + 16));
  assert_ptr_equal(entry, end);
  assert_int_equal(word_at(end + 12), entry - at);
  return out;
}

static int scale_step(const CagColorScale *s, double value) {
  return (int)fmin(fmax(floor((value - s->from) / (s->to - s->from) * 256), 0), 255);
}

static void threemf_has_every_corner(void **state) {
  (void)state;
  static size_t points[5000];
  seed = 6;
  for (int round = 0; round < 9; round++) {
    Scene s;
    random_scene(&s, round);
    size_t size, built = 0;
    char *b = bytes_of(s.parts, s.count, cag_export_3mf, &size), *xml = model_of(b, size);
    const char *at = xml;
    // Materials in the order of the parts that use them.
    const CagMaterial *const materials[] = {&s.materials[0], &s.materials[1], &s.materials[3],
                                            &s.materials[2]};
    for (int k = 0; k < 4; k++) {
      const CagMaterial *m = materials[k];
      char base[100];
      snprintf(base, sizeof base, "   <base name=\"%s\" displaycolor=\"#%02X%02X%02X%02X\"/>\n",
               m->name, srgb_byte(m->color.r), srgb_byte(m->color.g), srgb_byte(m->color.b),
               (int)(255 * (1 - m->transmission) + 0.5));
      const char *found = strstr(at, base);
      if (!found) fail_msg("no %s", base);
      at = found;
    }
    for (size_t i = 0; i < s.count; i++) {
      const CagMesh *m = s.parts[i].mesh;
      size_t kept = 0, n = 0;
      for (size_t t = 0; t < m->triangle_count; t++) kept += !shrinks(m, t);
      char head[100];
      snprintf(head, sizeof head, "  <object id=\"%zu\" type=\"surface\" name=\"", i + 2);
      const char *object = strstr(xml, head);
      assert_true((object != NULL) == (kept > 0));
      snprintf(head, sizeof head, "<item objectid=\"%zu\"/>", i + 2);
      assert_true((strstr(xml, head) != NULL) == (kept > 0));
      if (!object) continue;
      built++;
      if (i == 1) { // a copy of part 0
        CagVec3 c[4];
        object = strstr(object, "<component objectid=\"2\" transform=\"");
        assert_int_equal(sscanf(object,
                                "<component objectid=\"2\" transform=\"%lf %lf %lf %lf %lf %lf "
                                "%lf %lf %lf %lf %lf %lf\"",
                                &c[0].x, &c[0].y, &c[0].z, &c[1].x, &c[1].y, &c[1].z, &c[2].x,
                                &c[2].y, &c[2].z, &c[3].x, &c[3].y, &c[3].z),
                         12);
        for (size_t v = 0; v < m->vertex_count; v++) {
          const CagVec3 p = s.parts[0].mesh->positions[v];
          CagVec3 q = cag_madd(c[3], p.x, c[0]);
          q = cag_madd(cag_madd(q, p.y, c[1]), p.z, c[2]);
          assert_true(distance(q, m->positions[v]) < 1e-9);
        }
        continue;
      }
      const CagMaterial *material = s.parts[i].material;
      const char *close = strchr(strstr(object, "name=\"") + 6, '>'),
                 *pid = strstr(object, "pid=\"1\"");
      assert_true((pid && pid < close) == (material != NULL));
      if (material) {
        int k = 0;
        while (materials[k] != material) k++;
        assert_int_equal(strtol(strstr(pid, "pindex=\"") + 8, NULL, 10), k);
      }
      const char *end = strstr(object, "</object>"), *p = object;
      for (size_t v = 0; v < m->vertex_count; v++) {
        points[v] = m->weld ? points[m->weld[v]] : n;
        if (m->weld && m->weld[v] != v) continue;
        points[v] = n++;
        CagVec3 q;
        p = strstr(p + 1, "<vertex ");
        assert_int_equal(sscanf(p, "<vertex x=\"%lf\" y=\"%lf\" z=\"%lf\"/>", &q.x, &q.y, &q.z), 3);
        assert_true(distance(q, m->positions[v]) < 2e-6);
      }
      const char *next = strstr(p + 1, "<vertex ");
      assert_true(!next || next > end);
      for (size_t t = 0; t < m->triangle_count; t++) {
        if (shrinks(m, t)) continue;
        const uint32_t *k = m->triangles + 3 * t;
        char line[200];
        int used = snprintf(line, sizeof line, "<triangle v1=\"%zu\" v2=\"%zu\" v3=\"%zu\"",
                            points[k[0]], points[k[1]], points[k[2]]);
        if (m->scale.kind)
          used += snprintf(
              line + used, sizeof line - (size_t)used, " pid=\"%zu\" p1=\"%d\" p2=\"%d\" p3=\"%d\"",
              s.count + 2 + i, scale_step(&m->scale, m->uv[2 * k[0]]),
              scale_step(&m->scale, m->uv[2 * k[1]]), scale_step(&m->scale, m->uv[2 * k[2]]));
        snprintf(line + used, sizeof line - (size_t)used, "/>\n");
        p = strstr(p + 1, "<triangle ");
        if (!p || strncmp(p, line, strlen(line)) != 0)
          fail_msg("%.100s, not %s", p ? p : "none", line);
      }
      next = strstr(p + 1, "<triangle ");
      assert_true(!next || next > end);
      if (!m->scale.kind) continue;
      snprintf(head, sizeof head, "<m:colorgroup id=\"%zu\">", s.count + 2 + i);
      p = strstr(xml, head);
      assert_true(p && p < object); // a group precedes the objects that refer to it
      for (int k = 0; k < 256; k++) {
        const CagColor c = cag_color_scale_at(
            &m->scale, m->scale.from + (m->scale.to - m->scale.from) * (k + 0.5) / 256);
        snprintf(head, sizeof head, "<m:color color=\"#%02X%02X%02X\"/>", srgb_byte(c.r),
                 srgb_byte(c.g), srgb_byte(c.b));
        p = strstr(p + 1, "<m:color ");
        assert_memory_equal(p, head, strlen(head));
      }
    }
    assert_int_equal(built, 8);
    free(xml);
    free(b);
    scene_free(&s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(threemf_has_every_corner),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
