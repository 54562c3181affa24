// Removes the noise of few samples of light.
//
// The light that arrives at surfaces is smoothed across pixels whose surfaces have about the same
// normal and depth, as far as its samples vary (an edge-avoiding wavelet: Dammertz, Sewtz, Hanika,
// and Lensch 2010; guided by the variance: Schied et al. 2017). Colors, edges, and reflections stay
// sharp.

#ifndef CAG_INTERP_RENDER_PREVIEW_SMOOTH_H
#define CAG_INTERP_RENDER_PREVIEW_SMOOTH_H

#include <stdbool.h>
#include <stddef.h>

// How far a pixel's neighbors influence it.
#define CAG_PREVIEW_SMOOTH_REACH 14

// Sums over the samples of a pixel.
typedef struct CagPreviewSum {
  float color[3];
  float light[3], albedo[3]; // of what the camera's rays meet first
  float square;              // of the brightness of the light
  float normal[3], distance;
  float met; // number of samples that meet something
} CagPreviewSum;

// Replaces the sums of colors by smoothed ones. Work is divided among threads. Returns false if
// memory is out or the work is stopped.
bool cag_preview_smooth(CagPreviewSum *sums, size_t width, size_t height, int samples);

#endif
