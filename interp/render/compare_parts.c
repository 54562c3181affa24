#include "interp/render/compare_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "interp/render/compare.h"

#define LAYER "CryptoObject"

typedef struct Comparison {
  const CagImage *image[2];
  size_t channels[2][CAG_CRYPTO_CHANNELS];
  size_t rgb[2][3];
  double threshold;
} Comparison;

static bool open_comparison(const CagPartPicture pictures[2], double threshold, Comparison *c,
                            CagError *err) {
  c->threshold = threshold;
  for (int k = 0; k < 2; k++) {
    c->image[k] = pictures[k].image;
    if (!cag_crypto_find(c->image[k], LAYER, c->channels[k]) ||
        !cag_image_find_color(c->image[k], c->rgb[k]))
      return cag_fail_io(err, CAG_E_ARGUMENT, "render it with --passes color,object",
                         "the %s picture has no colors or no layer of objects",
                         k ? "second" : "first");
  }
  if (c->image[0]->width != c->image[1]->width || c->image[0]->height != c->image[1]->height)
    return cag_fail_io(err, CAG_E_ARGUMENT, NULL, "the pictures have different sizes");
  return true;
}

// The difference of a pixel: of the channels, and of the color as it is seen.
static double channel_difference(const Comparison *c, size_t pixel, double *seen) {
  double lab[2][3], most = 0;
  for (int k = 0; k < 2; k++) {
    double rgb[3];
    for (int i = 0; i < 3; i++) rgb[i] = cag_image_plane(c->image[k], c->rgb[k][i])[pixel];
    cag_compare_lab(rgb, lab[k]);
  }
  for (int i = 0; i < 3; i++)
    most = fmax(most, fabs((double)cag_image_plane(c->image[0], c->rgb[0][i])[pixel] -
                           (double)cag_image_plane(c->image[1], c->rgb[1][i])[pixel]));
  *seen = cag_compare_delta_e(lab[0], lab[1]);
  return most;
}

static void compare_part(const Comparison *c, float hash, const double *difference,
                         const double *seen, CagPartDifference *out) {
  const size_t n = c->image[0]->width * c->image[0]->height;
  double both = 0, either = 0, sum = 0;
  for (size_t i = 0; i < n; i++) {
    const double a = cag_crypto_covered(c->image[0], c->channels[0], i, hash),
                 b = cag_crypto_covered(c->image[1], c->channels[1], i, hash), w = fmax(a, b);
    out->pixels[0] += a;
    out->pixels[1] += b;
    if (w == 0) continue;
    both += fmin(a, b);
    either += w;
    sum += w * seen[i];
    out->largest = fmax(out->largest, seen[i]);
    if (difference[i] > c->threshold) out->changed += w;
  }
  out->overlap = either > 0 ? both / either : 1;
  out->mean = either > 0 ? sum / either : 0;
}

static int by_change(const void *a, const void *b) {
  const CagPartDifference *p = a, *q = b;
  const double x = p->changed + p->mean * 1e-9, y = q->changed + q->mean * 1e-9;
  if (x != y) return x < y ? 1 : -1;
  return strcmp(p->name, q->name);
}

static void add_names(const CagPartPicture pictures[2], CagPartReport *out, float *hashes) {
  for (int k = 0; k < 2; k++)
    for (size_t i = 0; i < pictures[k].manifest->n; i++) {
      const char *name = pictures[k].manifest->names[i];
      size_t at = 0;
      while (at < out->n && strcmp(out->parts[at].name, name) != 0) at++;
      if (at == out->n) {
        out->parts[at].name = name;
        hashes[at] = pictures[k].manifest->hashes[i];
        out->n++;
      }
      out->parts[at].in[k] = true;
    }
}

bool cag_compare_parts(const CagPartPicture pictures[2], double threshold, CagPartReport *out,
                       CagError *err) {
  Comparison c;
  *out = (CagPartReport){0};
  if (!open_comparison(pictures, threshold, &c, err)) return false;
  const size_t most = pictures[0].manifest->n + pictures[1].manifest->n + 1;
  const size_t n = c.image[0]->width * c.image[0]->height;
  float *hashes = cag_malloc(most * sizeof *hashes);
  double *difference = cag_malloc(2 * n * sizeof *difference);
  out->parts = cag_calloc(most, sizeof *out->parts);
  const bool good = hashes && difference && out->parts;
  if (good) {
    double *seen = difference + n;
    for (size_t i = 0; i < n; i++) difference[i] = channel_difference(&c, i, &seen[i]);
    add_names(pictures, out, hashes);
    for (size_t i = 0; i < out->n; i++)
      compare_part(&c, hashes[i], difference, seen, &out->parts[i]);
    qsort(out->parts, out->n, sizeof *out->parts, by_change);
  }
  cag_free(hashes);
  cag_free(difference);
  if (!good) cag_part_report_free(out);
  return good || cag_fail_io(err, CAG_E_MEMORY, NULL, "not enough memory");
}

void cag_part_report_free(CagPartReport *r) {
  cag_free(r->parts);
  *r = (CagPartReport){0};
}

void cag_part_report_print(const CagPartReport *r, FILE *out) {
  fprintf(out, "%-24s %10s %10s %8s %10s %8s %8s\n", "part", "pixels", "then", "overlap", "changed",
          "mean dE", "largest");
  for (size_t i = 0; i < r->n; i++) {
    const CagPartDifference *p = &r->parts[i];
    fprintf(out, "%-24s %10.1f %10.1f %8.4f %10.1f %8.3f %8.3f%s\n", p->name, p->pixels[0],
            p->pixels[1], p->overlap, p->changed, p->mean, p->largest,
            !p->in[1]   ? "  only in the first"
            : !p->in[0] ? "  only in the second"
                        : "");
  }
}
