/* SPDX-License-Identifier: MIT */
#include "c/host.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { most_channels = 5, vector = 6, portion = 50 };

float host_radiance(double x, double y, size_t channel) {
  if (channel == 3) return (float)(floor(x / 5) + 100 * floor(y / 5));
  return (float)((x + 0.7 * y > 30 + 3.0 * (double)channel ? 1.0 : 0.2) +
                 0.1 * sin(x * y / (9.0 + (double)channel)));
}

/* --------------------------------------------------------------------------------- callbacks */

struct layout {
  size_t channels, stride;
};

static void fill(const struct layout* layout, const freqsynth_request* requests, size_t count,
                 float* values) {
  size_t i, c;
  for (i = 0; i < count; ++i) {
    for (c = 0; c < layout->channels; ++c) {
      values[i * layout->stride + c] = host_radiance(requests[i].x, requests[i].y, c);
    }
  }
}

static int sample(void* user, const freqsynth_request* requests, size_t count, float* values) {
  fill((const struct layout*)user, requests, count, values);
  return 0;
}

static int execute_backwards(void* user, size_t count, freqsynth_task task, const void* context) {
  *(size_t*)user += count;
  while (count > 0) task(context, --count);
  return 0;
}

static double highest_fraction = 0;

static int watch(void* user, const freqsynth_progress* progress) {
  *(int*)user += 1;
  if (progress->struct_size < sizeof *progress || progress->fraction < highest_fraction) return 1;
  highest_fraction = progress->fraction;
  return 0;
}

/* ----------------------------------------------------------------------------------- pictures */

static int failed(const char* what) {
  fprintf(stderr, "%s: %s\n", what, freqsynth_last_error());
  return 1;
}

static int run(freqsynth_synthesizer* engine, const freqsynth_stop_rule* rule, int way,
               struct layout* layout) {
  freqsynth_run_options options;
  freqsynth_thread_pool* pool = NULL;
  freqsynth_executor executor;
  freqsynth_run_report report;
  size_t tasks = 0;
  int calls = 0;
  freqsynth_status status;

  freqsynth_run_options_init(&options, sizeof options);
  options.sampler = sample;
  options.sampler_user = layout;
  options.progress = watch;
  options.progress_user = &calls;
  highest_fraction = 0;
  executor.user = &tasks;
  executor.concurrency = 3;
  executor.execute = execute_backwards;
  if (way == HOST_RUN_POOL) {
    if (freqsynth_thread_pool_create(3, &pool) != FREQSYNTH_OK) return failed("thread pool");
    options.thread_pool = pool;
  } else if (way == HOST_RUN_EXECUTOR) {
    options.executor = &executor;
  } else if (way == HOST_RUN_STRIDED) {
    options.value_stride = layout->stride = vector;
  }
  report.struct_size = sizeof report;
  status = freqsynth_run(engine, rule, &options, &report);
  freqsynth_thread_pool_destroy(pool);
  if (status != FREQSYNTH_OK) return failed("run");
  if (calls == 0 || report.reason == FREQSYNTH_STOP_NONE) return failed("report");
  if (way == HOST_RUN_EXECUTOR && tasks == 0) return failed("executor");
  return 0;
}

static int loop(freqsynth_synthesizer* engine, const freqsynth_stop_rule* rule,
                struct layout* layout, size_t stride) {
  freqsynth_request requests[portion];
  float values[portion * vector];
  size_t count, back, turn = 0;
  int32_t reason;
  layout->stride = stride == 0 ? layout->channels : stride;
  if (freqsynth_set_stop(engine, rule) != FREQSYNTH_OK) return failed("set_stop");
  for (;; ++turn) {
    if (freqsynth_request_samples(engine, requests, portion, FREQSYNTH_WAIT_NO, &count) !=
        FREQSYNTH_OK) {
      return failed("request");
    }
    if (count == 0) break;
    back = turn % 3 == 0 ? count / 2 : 0;
    if (freqsynth_give_back(engine, requests, back) != FREQSYNTH_OK) return failed("give_back");
    fill(layout, requests + back, count - back, values);
    if (freqsynth_deliver(engine, requests + back, count - back, values, stride) !=
        FREQSYNTH_OK) {
      return failed("deliver");
    }
  }
  if (freqsynth_stopped(engine, &reason) != FREQSYNTH_OK) return failed("stopped");
  return reason == FREQSYNTH_STOP_SAMPLES || reason == FREQSYNTH_STOP_THRESHOLD ||
                 reason == FREQSYNTH_STOP_EXHAUSTED
             ? 0
             : failed("reason");
}

freqsynth_synthesizer* host_render(const freqsynth_settings* settings,
                                   const freqsynth_stop_rule* rule, int way) {
  freqsynth_synthesizer* engine = NULL;
  struct layout layout;
  int bad;
  layout.channels = layout.stride = settings->channels;
  if (layout.channels > most_channels) return NULL;
  if (freqsynth_synthesizer_create(settings, &engine) != FREQSYNTH_OK) {
    failed("create");
    return NULL;
  }
  if (way == HOST_LOOP || way == HOST_LOOP_STRIDED) {
    bad = loop(engine, rule, &layout, way == HOST_LOOP ? 0 : vector);
  } else {
    bad = run(engine, rule, way, &layout);
  }
  if (bad) {
    freqsynth_synthesizer_destroy(engine);
    return NULL;
  }
  return engine;
}

/* ------------------------------------------------------------------------------------ answers */

#define CHECK(condition)     \
  do {                       \
    if (!(condition)) return __LINE__; \
  } while (0)
#define OK(call) CHECK((call) == FREQSYNTH_OK)

static int sees_images(freqsynth_synthesizer* engine, const char* file) {
  enum { width = 40, height = 28 };
  static float pixels[width * height * 3], same[width * height * 3];
  freqsynth_image *fitted = NULL, *finished = NULL, *loaded = NULL;
  freqsynth_image_info info;
  freqsynth_pixels view = {NULL, width, height, 0, 0, 0};
  float coefficients[64], values[3], planes[width * height * 3];
  uint32_t samples = 0;
  size_t i, p;

  view.data = pixels;
  OK(freqsynth_finish(engine, NULL, NULL, &view));
  OK(freqsynth_fitted_image(engine, &fitted));
  OK(freqsynth_finished_image(engine, NULL, &finished));
  memset(&info, 0xff, sizeof info);
  info.struct_size = sizeof info;
  OK(freqsynth_image_get_info(fitted, &info));
  CHECK(info.width == width && info.height == height && info.channels == 3);
  CHECK(info.blocks_x == 5 && info.blocks_y == 4 && info.finished == 0);
  OK(freqsynth_image_get_info(finished, &info));
  CHECK(info.finished == 1);
  OK(freqsynth_image_get_block(finished, 4, 3, 2, coefficients, &samples));
  CHECK(samples > 0 && coefficients[0] > 0);
  OK(freqsynth_image_get_block(finished, 4, 3, 2, NULL, NULL));
  OK(freqsynth_evaluate(fitted, NULL, 3.5, 20.25, values, 3));
  CHECK(values[0] > 0 && values[0] < 2);

  OK(freqsynth_image_save(finished, file));
  OK(freqsynth_image_load(file, &loaded));
  view.data = same;
  OK(freqsynth_reconstruct(loaded, NULL, &view));
  CHECK(memcmp(pixels, same, sizeof pixels) == 0);
  view.data = planes;
  view.channel_stride = width * height;
  OK(freqsynth_reconstruct(finished, NULL, &view));
  for (i = 0; i < 3; ++i) {
    for (p = 0; p < width * height; ++p) {
      CHECK(planes[i * width * height + p] == pixels[3 * p + i]);
    }
  }
  freqsynth_image_destroy(fitted);
  freqsynth_image_destroy(finished);
  freqsynth_image_destroy(loaded);
  return 0;
}

static int sees_numbers(freqsynth_synthesizer* engine) {
  freqsynth_stats stats;
  freqsynth_progress progress;
  freqsynth_bad_sample bad[4];
  freqsynth_request requests[8];
  freqsynth_stop_rule rule;
  size_t size, count;
  int32_t noisy = 7, reason = 7;

  stats.struct_size = sizeof stats;
  OK(freqsynth_get_stats(engine, &stats));
  CHECK(stats.samples >= 2240 && stats.waves > 0 && stats.blocks == 20 && stats.absorbed > 0);
  CHECK(stats.probes > 0 && stats.differing_probes == 0 && stats.abandoned == 0);
  CHECK(stats.bad_samples == 0 && stats.ignored_bad_samples == 0);
  OK(freqsynth_get_bad_samples(engine, bad, 4, &count));
  CHECK(count == 0);
  OK(freqsynth_is_noisy(engine, &noisy));
  CHECK(noisy == 0);
  OK(freqsynth_wave_size(engine, &size));
  CHECK(size > 0);
  progress.struct_size = sizeof progress;
  OK(freqsynth_get_progress(engine, &progress));
  CHECK(progress.fraction == 1 && progress.samples == stats.samples);
  CHECK(progress.revision == stats.waves && progress.seconds_left == 0);

  freqsynth_stop_rule_init(&rule, sizeof rule);
  rule.samples = stats.samples + 100;
  OK(freqsynth_set_stop(engine, &rule));
  OK(freqsynth_stopped(engine, &reason));
  CHECK(reason == FREQSYNTH_STOP_NONE);
  OK(freqsynth_request_samples(engine, requests, 2, FREQSYNTH_WAIT_UNTIL_AVAILABLE, &count));
  CHECK(count > 0 && requests[0].reserved[0] == 0 && requests[0].reserved[6] == 0);
  OK(freqsynth_abandon(engine, requests, count));
  stats.abandoned = 0;
  OK(freqsynth_get_stats(engine, &stats));
  CHECK(stats.abandoned == count);
  OK(freqsynth_cancel(engine));
  OK(freqsynth_request_samples(engine, requests, 2, FREQSYNTH_WAIT_UNTIL_AVAILABLE, &count));
  CHECK(count == 0);
  OK(freqsynth_stopped(engine, &reason));
  CHECK(reason == FREQSYNTH_STOP_CANCELLED);
  return 0;
}

int host_looks_around(const char* file) {
  freqsynth_settings settings;
  freqsynth_stop_rule rule;
  freqsynth_synthesizer* engine;
  freqsynth_list* list = NULL;
  int line;
  OK(freqsynth_list_create(NULL, &list));
  freqsynth_settings_init(&settings, sizeof settings);
  settings.width = 40;
  settings.height = 28;
  settings.shared_list = list;
  freqsynth_stop_rule_init(&rule, sizeof rule);
  rule.samples_per_pixel = 2;
  engine = host_render(&settings, &rule, HOST_RUN_SERIAL);
  freqsynth_list_destroy(list); /* the engine keeps what it needs */
  CHECK(engine != NULL);
  line = sees_images(engine, file);
  if (line == 0) line = sees_numbers(engine);
  freqsynth_synthesizer_destroy(engine);
  return line;
}
