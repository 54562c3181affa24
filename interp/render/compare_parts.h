// Which parts of a scene differ between two pictures that have Cryptomatte layers of objects.

#ifndef CAG_INTERP_RENDER_COMPARE_PARTS_H
#define CAG_INTERP_RENDER_COMPARE_PARTS_H

#include <stdio.h>

#include "interp/render/cryptomatte.h"

// How a part differs. Pixels count by the fraction that the part covers in the first picture or, if
// it is larger, in the second.
typedef struct CagPartDifference {
  const char *name;     // in one of the manifests
  bool in[2];           // whether the pictures have a part of this name
  double pixels[2];     // covered in each
  double overlap;       // the common part of what it covers in both, as a fraction of all
  double changed;       // pixels whose color differs by more than the threshold
  double mean, largest; // color difference, CIEDE2000
} CagPartDifference;

typedef struct CagPartReport {
  size_t n;
  CagPartDifference *parts; // most changed first
} CagPartReport;

typedef struct CagPartPicture {
  const CagImage *image;
  const CagCryptoManifest *manifest; // of the layer CryptoObject
} CagPartPicture;

// Compares pictures of one size that have colors. Fails if one has no layer CryptoObject.
bool cag_compare_parts(const CagPartPicture pictures[2], double threshold, CagPartReport *out,
                       CagError *err);
void cag_part_report_free(CagPartReport *r);
void cag_part_report_print(const CagPartReport *r, FILE *out);

#endif
