// Comparison of two pictures of the same size and channels.
//
// Channels are matched by name, in any order. The statistics of a channel include the samples that
// are finite in both pictures. Two NaNs, or two equal infinities, count as equal. Any other pair
// that contains a NaN or infinity counts as differing by more than every threshold and is reported
// separately.
//
// The perceptual measure is the color difference CIEDE2000 (Sharma, Wu, Dalal, "The CIEDE2000
// Color-Difference Formula: Implementation Notes, Supplementary Test Data, and Mathematical
// Observations", Color Research and Application 30, 2005) of the colors as displayed: linear light
// clipped to 0..1, sRGB primaries, D65, CIELAB. A difference of about 1 is just noticeable side by
// side; black and white differ by 100.

#ifndef CAG_INTERP_RENDER_COMPARE_H
#define CAG_INTERP_RENDER_COMPARE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "base/status.h"
#include "interp/render/image.h"

typedef struct CagCompareChannel {
  char name[CAG_IMAGE_NAME_MAX + 1];
  double rmse;    // root of the mean square difference
  double largest; // largest absolute difference, at (x, y); y goes down
  size_t largest_x, largest_y;
  double psnr;          // in dB: 20 log10(peak / rmse), infinite when rmse is 0
  double peak;          // largest finite |value| of the first picture's channel, at least 1
  size_t samples;       // that are finite in both
  size_t not_finite[2]; // NaN and infinite samples of the first and the second picture
  size_t unlike;        // samples that are not finite in one or both pictures, and differ
} CagCompareChannel;

typedef struct CagCompareReport {
  size_t width, height;
  size_t channel_count;
  CagCompareChannel *channels; // in the order of the first picture
  double threshold;
  size_t differing_pixels; // pixels with a channel that differs by more than the threshold, or is
                           // unlike
  bool has_color;          // both have R G B (or Y), and the following values are set
  double delta_e_mean, delta_e_largest;
} CagCompareReport;

// Compares `b` with the reference `a`. A pixel differs if one of its channels differs by more than
// `threshold` (at least 0). The names are used in messages. Pictures of different sizes or channels
// are an error of status CAG_E_ARGUMENT. Release the report with cag_compare_report_free.
bool cag_compare_images(const CagImage *a, const char *a_name, const CagImage *b,
                        const char *b_name, double threshold, CagCompareReport *out, CagError *err);

void cag_compare_report_free(CagCompareReport *report);

// Writes the report as a table for people.
void cag_compare_print(const CagCompareReport *report, FILE *out);

// Makes a picture of the differences between two comparable pictures. The color of a pixel runs
// from black through red and yellow to white as its largest difference increases from 0 to that of
// the worst pixel. Magenta marks pixels that are unlike (see above). The channel `difference` holds
// the largest difference itself (infinity for unlike pixels). Release with cag_image_free.
bool cag_compare_heatmap(const CagImage *a, const CagImage *b, CagImage *out, CagError *err);

// The CIEDE2000 difference of two CIELAB colors, with all weights 1.
double cag_compare_delta_e(const double lab1[3], const double lab2[3]);

// CIELAB (D65) of a color of linear sRGB, clipped to 0..1; NaN counts as 0.
void cag_compare_lab(const double linear_rgb[3], double lab[3]);

#endif
