/* SPDX-License-Identifier: MIT */
/* A host in C: a picture with a loop of its own, as a file. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "freqsynth/c/freqsynth.h"

enum { width = 256, height = 256 };

/* A host's vectors have four floats, of which the engine reads three. */
static void trace(const freqsynth_request* ray, float* color) {
  const double rings = 0.5 + 0.5 * cos(0.002 * (ray->x * ray->x + ray->y * ray->y));
  color[0] = (float)rings;
  color[1] = (float)(rings * ray->x / width);
  color[2] = 0.5f;
}

static void check(freqsynth_status status) {
  if (status == FREQSYNTH_OK) return;
  fprintf(stderr, "%s\n", freqsynth_last_error());
  exit(1);
}

static void render(freqsynth_synthesizer* engine) {
  freqsynth_request rays[64];
  float colors[64][4];
  size_t count, i;
  /* Any number of threads may do this at the same time: each waits for what the others owe. */
  for (;;) {
    check(freqsynth_request_samples(engine, rays, 64, FREQSYNTH_WAIT_UNTIL_AVAILABLE, &count));
    if (count == 0) return;
    for (i = 0; i < count; ++i) trace(&rays[i], colors[i]);
    check(freqsynth_deliver(engine, rays, count, &colors[0][0], 4));
  }
}

int main(void) {
  freqsynth_settings settings;
  freqsynth_stop_rule rule;
  freqsynth_reconstruction_settings filter;
  freqsynth_stats stats;
  freqsynth_synthesizer* engine = NULL;
  static float pixels[height][width][3];
  freqsynth_pixels view = {&pixels[0][0][0], width, height, 0, 0, 0};
  FILE* file;
  size_t i;

  freqsynth_settings_init(&settings, sizeof settings); /* the defaults */
  settings.width = width;
  settings.height = height;
  freqsynth_stop_rule_init(&rule, sizeof rule);
  rule.samples_per_pixel = 2;
  check(freqsynth_synthesizer_create(&settings, &engine));
  check(freqsynth_set_stop(engine, &rule));
  render(engine);

  freqsynth_reconstruction_settings_init(&filter, sizeof filter);
  filter.pixel_filter = FREQSYNTH_FILTER_GAUSSIAN;
  check(freqsynth_finish(engine, NULL, &filter, &view));
  stats.struct_size = sizeof stats;
  check(freqsynth_get_stats(engine, &stats));
  printf("%lu samples\n", (unsigned long)stats.samples);
  freqsynth_synthesizer_destroy(engine);

  file = fopen("c_host.ppm", "wb");
  if (file == NULL) return 1;
  fprintf(file, "P6 %d %d 255\n", width, height);
  for (i = 0; i < (size_t)width * height * 3; ++i) {
    const float value = (&pixels[0][0][0])[i];
    fputc((int)(255 * (value < 0 ? 0 : value > 1 ? 1 : value) + 0.5f), file);
  }
  return fclose(file) == 0 ? 0 : 1;
}
