#include "live/meshes.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

enum { ID_SIZE = 33, BUCKETS = 4096 };

typedef struct Mesh {
  char id[ID_SIZE];
  unsigned char *bytes;
  size_t size;
  unsigned long scene, used; // the last scene it belonged to; the time of the last use
  struct Mesh *next;
} Mesh;

struct CagMeshes {
  pthread_mutex_t mutex;
  Mesh *buckets[BUCKETS];
  size_t most, total;
  unsigned long scene, clock;
};

CagMeshes *cag_meshes_new(size_t most_bytes) {
  CagMeshes *m = calloc(1, sizeof *m);
  if (!m) return NULL;
  m->most = most_bytes;
  pthread_mutex_init(&m->mutex, NULL);
  return m;
}

static void free_mesh(Mesh *mesh) {
  free(mesh->bytes);
  free(mesh);
}

void cag_meshes_free(CagMeshes *m) {
  if (!m) return;
  for (size_t i = 0; i < BUCKETS; i++)
    for (Mesh *at = m->buckets[i], *next; at; at = next) {
      next = at->next;
      free_mesh(at);
    }
  pthread_mutex_destroy(&m->mutex);
  free(m);
}

void cag_meshes_begin_scene(CagMeshes *m) {
  pthread_mutex_lock(&m->mutex);
  m->scene++;
  pthread_mutex_unlock(&m->mutex);
}

// The identity is a hash already: its first digits choose the bucket.
static Mesh **bucket_of(CagMeshes *m, const char *id) {
  char digits[4] = {0};
  memcpy(digits, id, strnlen(id, 3));
  return &m->buckets[strtoul(digits, NULL, 16) % BUCKETS];
}

static Mesh *find(CagMeshes *m, const char *id) {
  for (Mesh *at = *bucket_of(m, id); at; at = at->next)
    if (!strcmp(at->id, id)) return at;
  return NULL;
}

static void touch(CagMeshes *m, Mesh *mesh) { mesh->used = ++m->clock; }

bool cag_meshes_has(CagMeshes *m, const char *id) {
  pthread_mutex_lock(&m->mutex);
  Mesh *mesh = find(m, id);
  if (mesh) {
    mesh->scene = m->scene;
    touch(m, mesh);
  }
  pthread_mutex_unlock(&m->mutex);
  return mesh != NULL;
}

static Mesh **oldest(CagMeshes *m) {
  Mesh **found = NULL;
  for (size_t i = 0; i < BUCKETS; i++)
    for (Mesh **at = &m->buckets[i]; *at; at = &(*at)->next)
      if ((*at)->scene + 1 < m->scene && (!found || (*at)->used < (*found)->used)) found = at;
  return found;
}

// Meshes of the last scene may still be asked for while the next one is made.
static void evict(CagMeshes *m) {
  Mesh **at;
  while (m->total > m->most && (at = oldest(m))) {
    Mesh *mesh = *at;
    *at = mesh->next;
    m->total -= mesh->size;
    free_mesh(mesh);
  }
}

bool cag_meshes_keep(CagMeshes *m, const char *id, unsigned char *bytes, size_t size) {
  Mesh *mesh = calloc(1, sizeof *mesh);
  if (!mesh) {
    free(bytes);
    return false;
  }
  strncpy(mesh->id, id, ID_SIZE - 1);
  mesh->bytes = bytes;
  mesh->size = size;
  pthread_mutex_lock(&m->mutex);
  Mesh **bucket = bucket_of(m, id), *known = find(m, id);
  if (known) {
    known->scene = m->scene;
    touch(m, known);
    free_mesh(mesh);
  } else {
    mesh->scene = m->scene;
    mesh->next = *bucket;
    *bucket = mesh;
    m->total += size;
    touch(m, mesh);
    evict(m);
  }
  pthread_mutex_unlock(&m->mutex);
  return true;
}

unsigned char *cag_meshes_copy(CagMeshes *m, const char *id, size_t *size) {
  unsigned char *copy = NULL;
  pthread_mutex_lock(&m->mutex);
  const Mesh *mesh = find(m, id);
  if (mesh) {
    *size = mesh->size;
    copy = malloc(mesh->size + 1);
    if (copy) memcpy(copy, mesh->bytes, mesh->size);
  }
  pthread_mutex_unlock(&m->mutex);
  return copy;
}
