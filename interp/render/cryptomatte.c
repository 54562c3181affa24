#include "interp/render/cryptomatte.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cjson/cJSON.h>

#include "base/memory.h"

// --- Hashes ---

static uint32_t rotated(uint32_t x, int by) { return x << by | x >> (32 - by); }

static uint32_t scrambled(uint32_t k) {
  return rotated(k * UINT32_C(0xcc9e2d51), 15) * UINT32_C(0x1b873593);
}

// MurmurHash3_x86_32 (Appleby 2011) with seed 0.
static uint32_t murmur3(const char *text) {
  const size_t n = strlen(text);
  uint32_t h = 0, k = 0;
  for (size_t i = 0; i + 4 <= n; i += 4) {
    const unsigned char *b = (const unsigned char *)text + i;
    k = (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
    h = rotated(h ^ scrambled(k), 13) * 5 + UINT32_C(0xe6546b64);
  }
  k = 0;
  for (size_t i = n & 3; i > 0; i--) k = k << 8 | (unsigned char)text[(n & ~(size_t)3) + i - 1];
  h ^= scrambled(k) ^ (uint32_t)n;
  h = (h ^ h >> 16) * UINT32_C(0x85ebca6b);
  h = (h ^ h >> 13) * UINT32_C(0xc2b2ae35);
  return h ^ h >> 16;
}

float cag_crypto_hash(const char *name) {
  uint32_t bits = murmur3(name);
  const uint32_t exponent = bits >> 23 & 255;
  if (exponent == 0 || exponent == 255) bits ^= UINT32_C(1) << 23;
  float f;
  memcpy(&f, &bits, sizeof f);
  return f;
}

void cag_crypto_digits(float hash, char out[9]) {
  uint32_t bits;
  memcpy(&bits, &hash, sizeof bits);
  snprintf(out, 9, "%08x", bits);
}

// --- Writing ---

static void channel_name(const char *layer, size_t i, char out[64]) {
  snprintf(out, 64, "%s%02zu.%c", layer, i / 4, "rgba"[i % 4]);
}

void cag_crypto_name_channels(CagImage *image, size_t first, const char *layer) {
  for (size_t i = 0; i < CAG_CRYPTO_CHANNELS; i++) {
    char name[64];
    channel_name(layer, i, name);
    cag_image_set_name(image, first + i, name);
  }
}

static char *manifest_text(const char *const *names, size_t n) {
  cJSON *json = cJSON_CreateObject();
  bool good = json != NULL;
  for (size_t i = 0; good && i < n; i++) {
    char digits[9];
    cag_crypto_digits(cag_crypto_hash(names[i]), digits);
    good = cJSON_AddStringToObject(json, names[i], digits) != NULL;
  }
  char *text = good ? cJSON_PrintUnformatted(json) : NULL;
  cJSON_Delete(json);
  return text;
}

bool cag_crypto_describe(CagExrMetadata *m, const char *layer, const char *const *names, size_t n,
                         CagError *err) {
  char digits[9], key[64];
  cag_crypto_digits(cag_crypto_hash(layer), digits);
  digits[7] = '\0';
  char *manifest = manifest_text(names, n);
  if (!manifest) return cag_fail_io(err, CAG_E_MEMORY, NULL, "not enough memory");
  const char *const fields[][2] = {{"name", layer},
                                   {"hash", "MurmurHash3_32"},
                                   {"conversion", "uint32_to_float32"},
                                   {"manifest", manifest}};
  bool ok = true;
  for (int i = 0; ok && i < 4; i++) {
    snprintf(key, sizeof key, "cryptomatte/%s/%s", digits, fields[i][0]);
    ok = cag_exr_metadata_text(m, key, fields[i][1], err);
  }
  cJSON_free(manifest);
  return ok;
}

void cag_crypto_add(CagCryptoPixel *p, float hash, float fraction) {
  for (int i = 0; i < p->n; i++)
    if (p->hash[i] == hash) {
      p->covered[i] += fraction;
      return;
    }
  if (p->n == CAG_CRYPTO_RANKS) return;
  p->hash[p->n] = hash;
  p->covered[p->n++] = fraction;
}

void cag_crypto_store(CagCryptoPixel *p, CagImage *image, size_t first, size_t pixel) {
  for (int i = 1; i < p->n; i++)
    for (int k = i; k > 0 && p->covered[k] > p->covered[k - 1]; k--) {
      const float c = p->covered[k], h = p->hash[k];
      p->covered[k] = p->covered[k - 1];
      p->hash[k] = p->hash[k - 1];
      p->covered[k - 1] = c;
      p->hash[k - 1] = h;
    }
  for (size_t i = 0; i < CAG_CRYPTO_RANKS; i++) {
    const bool used = (int)i < p->n;
    cag_image_plane(image, first + 2 * i)[pixel] = used ? p->hash[i] : 0;
    cag_image_plane(image, first + 2 * i + 1)[pixel] = used ? p->covered[i] : 0;
  }
}

// --- Reading ---

void cag_crypto_manifest_free(CagCryptoManifest *m) {
  for (size_t i = 0; i < m->n; i++) cag_free(m->names[i]);
  cag_free(m->names);
  cag_free(m->hashes);
  *m = (CagCryptoManifest){0};
}

static bool read_manifest(const char *text, CagCryptoManifest *out) {
  cJSON *json = cJSON_Parse(text);
  const int n = cJSON_IsObject(json) ? cJSON_GetArraySize(json) : -1;
  bool good = n >= 0;
  if (good) {
    out->names = cag_calloc((size_t)n + 1, sizeof *out->names);
    out->hashes = cag_calloc((size_t)n + 1, sizeof *out->hashes);
    good = out->names && out->hashes;
  }
  const cJSON *entry = good ? json->child : NULL;
  for (; good && entry; entry = entry->next) {
    good = cJSON_IsString(entry) && strlen(entry->valuestring) == 8 &&
           (out->names[out->n] = cag_strdup(entry->string)) != NULL;
    if (!good) break;
    const uint32_t bits = (uint32_t)strtoul(entry->valuestring, NULL, 16);
    memcpy(&out->hashes[out->n++], &bits, sizeof bits);
  }
  cJSON_Delete(json);
  if (!good) cag_crypto_manifest_free(out);
  return good;
}

bool cag_crypto_manifest(const CagExrMetadata *m, const char *layer, CagCryptoManifest *out) {
  char digits[9], key[64];
  *out = (CagCryptoManifest){0};
  cag_crypto_digits(cag_crypto_hash(layer), digits);
  digits[7] = '\0';
  snprintf(key, sizeof key, "cryptomatte/%s/manifest", digits);
  const CagExrAttribute *a = cag_exr_metadata_find(m, key);
  return a && a->text && read_manifest(a->text, out);
}

bool cag_crypto_find(const CagImage *image, const char *layer,
                     size_t channels[CAG_CRYPTO_CHANNELS]) {
  for (size_t i = 0; i < CAG_CRYPTO_CHANNELS; i++) {
    char name[64];
    channel_name(layer, i, name);
    if (!cag_image_find(image, name, &channels[i])) return false;
  }
  return true;
}

float cag_crypto_covered(const CagImage *image, const size_t channels[CAG_CRYPTO_CHANNELS],
                         size_t pixel, float hash) {
  for (size_t i = 0; i < CAG_CRYPTO_RANKS; i++)
    if (cag_image_plane(image, channels[2 * i])[pixel] == hash)
      return cag_image_plane(image, channels[2 * i + 1])[pixel];
  return 0;
}
