// Selects a serial chain from a tree of links.

#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "interp/formats/urdf_read.h"

// The maximum number of names in a message.
enum { TOLD = 6 };

static CagStatus find(const CagUrdfTree *t, const char *name, const char *argument, size_t *out,
                      CagError *err) {
  for (size_t i = 0; i < t->node_count; i++)
    if (!strcmp(t->nodes[i].name, name)) {
      *out = i;
      return CAG_OK;
    }
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_urdf_chain, argument, -1, "%s has no link \"%.80s\"",
                  t->file, name);
}

static size_t children(const CagUrdfTree *t, size_t node, size_t *one) {
  size_t n = 0;
  for (size_t i = 0; i < t->edge_count; i++)
    if (t->edges[i].parent == node) {
      *one = i;
      n++;
    }
  return n;
}

static size_t parent(const CagUrdfTree *t, size_t node) {
  return t->edges[t->nodes[node].above].parent;
}

static bool is_below(const CagUrdfTree *t, size_t node, size_t top) {
  for (size_t steps = 0; steps <= t->node_count; steps++) {
    if (node == top) return true;
    if (t->nodes[node].above == CAG_URDF_NONE) return false;
    node = parent(t, node);
  }
  return false; // a ring
}

// Formats "a", "b" and 3 more.
typedef struct Names {
  char text[240];
  size_t count;
} Names;

static void add_name(Names *n, const char *name) {
  size_t used = strlen(n->text);
  if (n->count++ < TOLD)
    snprintf(n->text + used, sizeof n->text - used, "%s\"%.36s\"", used > 0 ? ", " : "", name);
}

static void end_names(Names *n) {
  size_t used = strlen(n->text);
  if (n->count > TOLD)
    snprintf(n->text + used, sizeof n->text - used, " and %zu more", n->count - TOLD);
}

static CagStatus find_root(const CagUrdfTree *t, size_t *out, CagError *err) {
  Names roots = {.count = 0};
  for (size_t i = 0; i < t->node_count; i++) {
    if (t->nodes[i].above != CAG_URDF_NONE) continue;
    *out = i;
    add_name(&roots, t->nodes[i].name);
  }
  end_names(&roots);
  if (roots.count == 1) return CAG_OK;
  if (roots.count == 0)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_urdf_chain, "path", -1,
                    "%s: the joints form a loop, so there is no first link", t->file);
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_urdf_branches, "path", -1,
                  "%s has several links without a parent joint: %s; `base` selects the first one",
                  t->file, roots.text);
}

static CagStatus fail_branches(const CagUrdfTree *t, size_t node, CagError *err) {
  Names tips = {.count = 0};
  size_t ignored;
  for (size_t i = 0; i < t->node_count; i++)
    if (children(t, i, &ignored) == 0 && is_below(t, i, node)) add_name(&tips, t->nodes[i].name);
  end_names(&tips);
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_urdf_branches, "tip", -1,
                  "%s: after the link \"%.40s\", the robot branches, to the ends %s; `tip` selects "
                  "the last link of the chain",
                  t->file, t->nodes[node].name, tips.text);
}

static CagStatus find_tip(const CagUrdfTree *t, size_t from, size_t *out, CagError *err) {
  size_t edge = 0;
  *out = from;
  for (size_t steps = 0; steps <= t->node_count; steps++) {
    size_t n = children(t, *out, &edge);
    if (n == 0) return CAG_OK;
    if (n > 1) return fail_branches(t, *out, err);
    *out = t->edges[edge].child;
  }
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_urdf_chain, "path", -1,
                  "%s: the joints after the link \"%.60s\" form a loop", t->file,
                  t->nodes[from].name);
}

CagStatus cag_urdf_chain(const CagUrdfTree *t, const char *base, const char *tip, size_t **out,
                         size_t *n, CagError *err) {
  size_t first = 0, last = 0, count = 0;
  CagStatus status = CAG_OK;
  if (base) status = find(t, base, "base", &first, err);
  else if (!tip) status = find_root(t, &first, err);
  if (status) return status;
  status = tip ? find(t, tip, "tip", &last, err) : find_tip(t, first, &last, err);
  if (status) return status;
  // Without a base, the chain starts at the root above the tip.
  size_t at = last;
  bool anywhere = tip && !base;
  while ((anywhere || at != first) && t->nodes[at].above != CAG_URDF_NONE) {
    at = parent(t, at);
    if (++count > t->node_count)
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_urdf_chain, "path", -1,
                      "%s: the joints above the link \"%.60s\" form a loop", t->file,
                      t->nodes[last].name);
  }
  if (!anywhere && at != first)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_urdf_chain, "base", -1,
                    "%s: the link \"%.60s\" is not above the link \"%.60s\"", t->file,
                    t->nodes[first].name, t->nodes[last].name);
  size_t *chain = cag_malloc((count + 1) * sizeof *chain);
  if (!chain) return cag_fail_memory(err);
  at = last;
  for (size_t i = count; i-- > 0; at = parent(t, at)) chain[i] = t->nodes[at].above;
  *out = chain;
  *n = count;
  return CAG_OK;
}
