// Attributes of shapes and of the groups around them, in random scripts, compared with a model of
// the rules: the innermost attribute wins. A color alone leaves the other properties to enclosing
// groups, and a material without a color gets the color of an enclosing group.

#include "interp/session/session.h"
#include "scene_fixture.h"
#include "session_support.h"
#include "tests/geom/random.h"

// The attributes of one shape or group. -1: not set.
typedef struct Said {
  bool material;
  double color, roughness, metallic; // the red component of the color
  double tolerance, radius, dash;
  bool style, hidden;
  char name[8];
} Said;

static const Said nothing = {.color = -1, .roughness = -1, .metallic = -1, .tolerance = 0};

static void combine_materials(Said *inner, const Said *outer) {
  if (!outer->material) return;
  const bool color_alone =
      inner->material && inner->color >= 0 && inner->roughness < 0 && inner->metallic < 0;
  if (!inner->material || color_alone) {
    inner->roughness = outer->roughness;
    inner->metallic = outer->metallic;
  }
  if (inner->color < 0) inner->color = outer->color;
  inner->material = true;
}

static void combine(Said *inner, const Said *outer) {
  combine_materials(inner, outer);
  if (inner->tolerance == 0) inner->tolerance = outer->tolerance;
  if (!inner->style) {
    inner->style = outer->style;
    inner->radius = outer->radius;
    inner->dash = outer->dash;
  }
  if (!*inner->name) memcpy(inner->name, outer->name, sizeof inner->name);
  inner->hidden = inner->hidden || outer->hidden;
}

static int below(int n) { return (int)uniform(0, n); }

// Sets another attribute of the shape or group, by appending to the script.
static void set_attribute(char *script, Said *holds) {
  Said more = nothing;
  char text[120];
  const int kind = below(12);
  const double x = (1 + below(7)) / 8.0, y = (1 + below(7)) / 8.0;
  switch (kind) {
  case 0:
  case 1:
    more.material = true;
    more.color = x;
    snprintf(text, sizeof text, " |> color([%g, 0, 0])", x);
    break;
  case 2:
    more.material = true;
    more.roughness = x;
    snprintf(text, sizeof text, " |> material({roughness: %g})", x);
    break;
  case 3:
    more.material = true;
    more.roughness = x;
    more.metallic = y;
    snprintf(text, sizeof text, " |> material({metallic: %g, roughness: %g})", y, x);
    break;
  case 4:
    more.material = true;
    more.color = x;
    more.metallic = y;
    snprintf(text, sizeof text, " |> material({metallic: %g, color: [%g, 0, 0]})", y, x);
    break;
  case 5:
    more.tolerance = x;
    snprintf(text, sizeof text, " |> tolerance(%g)", x);
    break;
  case 6:
    more.style = true;
    more.radius = x;
    snprintf(text, sizeof text, " |> line_style(%g)", x);
    break;
  case 7:
    more.style = true;
    more.radius = x;
    more.dash = y;
    snprintf(text, sizeof text, " |> line_style(%g, dash: %g)", x, y);
    break;
  case 8:
    snprintf(more.name, sizeof more.name, "n%d", below(9));
    snprintf(text, sizeof text, " |> named(\"%s\")", more.name);
    break;
  case 9:
    more.hidden = below(4) == 0;
    snprintf(text, sizeof text, more.hidden ? " |> hidden()" : " |> translate([1, 0, 0])");
    break;
  default: snprintf(text, sizeof text, " |> rotate(Z, 30deg)");
  }
  strcat(script, text);
  combine(holds, &more);
}

static void what_is_said_nearer_holds(void **state) {
  (void)state;
  seed = 7;
  for (int run = 0; run < 1500; run++) {
    char script[4000] = "show box(1), [for g in [line([0, 0, 0], [3, 0, 0])";
    Said holds = nothing;
    const int levels = 1 + below(3);
    for (int level = 0; level < levels; level++) {
      Said group = nothing;
      const int sayings = below(4);
      if (level > 0) strcat(script, " |> group()");
      for (int k = 0; k < sayings; k++) set_attribute(script, level == 0 ? &holds : &group);
      if (level > 0) combine(&holds, &group);
    }
    strcat(script, "]: g]");
    CagSession *s = new_session();
    CagShownCounts counts;
    if (cag_session_run_text(s, "script", script, strlen(script)) != CAG_STATUS_OK ||
        cag_session_scene(s, &counts) != CAG_STATUS_OK)
      fail_msg("%s", script);
    const CagItem *item = NULL;
    const CagMaterial *usual = NULL;
    for (size_t i = 0; i < s->scene.item_count; i++) {
      if (s->scene.items[i].kind == CAG_ITEM_CURVE) item = &s->scene.items[i];
      if (s->scene.items[i].kind == CAG_ITEM_SOLID)
        usual = &s->scene.materials[s->scene.items[i].material];
    }
    if (!item != holds.hidden) fail_msg("hidden? %s", script);
    if (item) {
      const CagMaterial *m = &s->scene.materials[item->material];
      if (holds.material && holds.color >= 0 && m->color.r != holds.color)
        fail_msg("red %g, not %g: %s", m->color.r, holds.color, script);
      if (holds.roughness >= 0 && m->roughness != holds.roughness)
        fail_msg("roughness %g, not %g: %s", m->roughness, holds.roughness, script);
      if (m->metallic != (holds.metallic >= 0 ? holds.metallic : usual->metallic))
        fail_msg("metallic %g, not %g: %s", m->metallic, holds.metallic, script);
      if (item->tolerance != holds.tolerance || item->line_radius != holds.radius ||
          item->dash != holds.dash)
        fail_msg("tolerance %g, radius %g, dash %g: %s", item->tolerance, item->line_radius,
                 item->dash, script);
      if (strcmp(item->name, *holds.name ? holds.name : "line") != 0)
        fail_msg("`%s`, not `%s`: %s", item->name, holds.name, script);
    }
    cag_session_free(s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(what_is_said_nearer_holds)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
