/* SPDX-License-Identifier: MIT */
#include <stdio.h>

#include "freqsynth/c/freqsynth.h"

static int gray(void* user, const freqsynth_request* requests, size_t count, float* values) {
  size_t i;
  (void)user;
  (void)requests;
  for (i = 0; i < count; ++i) values[i] = 0.25f;
  return 0;
}

/* Prints the version, and only that, when the library works. */
int main(void) {
  freqsynth_settings settings;
  freqsynth_run_options options;
  freqsynth_stop_rule rule;
  freqsynth_synthesizer* engine = NULL;
  float pixels[16 * 8];
  freqsynth_pixels view = {NULL, 16, 8, 0, 0, 0};
  int i;

  freqsynth_settings_init(&settings, sizeof settings);
  settings.width = 16;
  settings.height = 8;
  settings.channels = 1;
  freqsynth_run_options_init(&options, sizeof options);
  options.sampler = gray;
  freqsynth_stop_rule_init(&rule, sizeof rule);
  rule.samples_per_pixel = 1;
  if (freqsynth_synthesizer_create(&settings, &engine) != FREQSYNTH_OK) return 1;
  if (freqsynth_run(engine, &rule, &options, NULL) != FREQSYNTH_OK) return 1;
  view.data = pixels;
  if (freqsynth_finish(engine, NULL, NULL, &view) != FREQSYNTH_OK) return 1;
  for (i = 0; i < 16 * 8; ++i) {
    if (pixels[i] < 0.249f || pixels[i] > 0.251f) return 1;
  }
  freqsynth_synthesizer_destroy(engine);
  puts(freqsynth_version());
  return 0;
}
