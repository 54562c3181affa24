// Cryptomatte: which parts of a scene each pixel shows, and how much of it (Friedman and Jones 2015,
// "Fully automatic ID mattes with support for motion blur and transparency"; specification 1.2.0).
//
// The name of a part is hashed to a 32-bit float. A pixel has the hashes of the parts that cover
// most of it with the fractions that they cover, in pairs of channels of decreasing fraction:
// LAYER00.r and .g, LAYER00.b and .a, LAYER01.r and .g, and so on. A manifest in the metadata maps
// names to hashes.

#ifndef CAG_INTERP_RENDER_CRYPTOMATTE_H
#define CAG_INTERP_RENDER_CRYPTOMATTE_H

#include <stdint.h>

#include "interp/render/exr.h"
#include "interp/render/image.h"

// Parts that a pixel can have, and their channels.
#define CAG_CRYPTO_RANKS 6
#define CAG_CRYPTO_CHANNELS (2 * CAG_CRYPTO_RANKS)

// The hash of a name as a float, which is never 0, infinite, NaN, or denormal.
float cag_crypto_hash(const char *name);
// The 8 hexadecimal digits of the float's bits; `out` has 9 bytes.
void cag_crypto_digits(float hash, char out[9]);

// Names the channels from `first` on.
void cag_crypto_name_channels(CagImage *image, size_t first, const char *layer);
// Adds what describes a layer: its name, hash, conversion, and manifest of n names.
bool cag_crypto_describe(CagExrMetadata *m, const char *layer, const char *const *names, size_t n,
                         CagError *err);

// The parts of a pixel while its samples are counted.
typedef struct CagCryptoPixel {
  float hash[CAG_CRYPTO_RANKS];
  float covered[CAG_CRYPTO_RANKS];
  int n;
} CagCryptoPixel;
// Adds a sample. If there are more parts than ranks, the last ones are left out.
void cag_crypto_add(CagCryptoPixel *p, float hash, float fraction);
// Sorts by decreasing fraction and stores them in the channels from `first` on.
void cag_crypto_store(CagCryptoPixel *p, CagImage *image, size_t first, size_t pixel);

// --- Reading ---

// The names of a layer that a file has. Release them with cag_crypto_manifest_free.
typedef struct CagCryptoManifest {
  size_t n;
  char **names;
  float *hashes;
} CagCryptoManifest;
// Reads the manifest of a layer. Returns false, without an error, if the file has no such layer.
bool cag_crypto_manifest(const CagExrMetadata *m, const char *layer, CagCryptoManifest *out);
void cag_crypto_manifest_free(CagCryptoManifest *m);
// Finds the channels of a layer, in the order of the pairs.
bool cag_crypto_find(const CagImage *image, const char *layer,
                     size_t channels[CAG_CRYPTO_CHANNELS]);
// The fraction of a pixel that a part covers.
float cag_crypto_covered(const CagImage *image, const size_t channels[CAG_CRYPTO_CHANNELS],
                         size_t pixel, float hash);

#endif
