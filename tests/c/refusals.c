/* SPDX-License-Identifier: MIT */
/* What a host in C may get wrong. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "c/host.h"

#define CHECK(condition)     \
  do {                       \
    if (!(condition)) return __LINE__; \
  } while (0)
#define OK(call) CHECK((call) == FREQSYNTH_OK)
#define FAILS(call, status, text) \
  CHECK((call) == (status) && strstr(freqsynth_last_error(), (text)) != NULL)
#define REFUSED(call, text) FAILS(call, FREQSYNTH_INVALID_ARGUMENT, text)

static int sample(void* user, const freqsynth_request* requests, size_t count, float* values) {
  size_t i;
  (void)user;
  for (i = 0; i < count; ++i) values[i] = host_radiance(requests[i].x, requests[i].y, 0);
  return 0;
}

/* Fails with 42 at its third call. */
static int fail(void* user, const freqsynth_request* requests, size_t count, float* values) {
  if (++*(int*)user == 3) return 42;
  return sample(NULL, requests, count, values);
}

static int refuse_to_execute(void* user, size_t count, freqsynth_task task, const void* context) {
  (void)user;
  (void)count;
  (void)task;
  (void)context;
  return -5;
}

static int stop_at_once(void* user, const freqsynth_progress* progress) {
  (void)user;
  (void)progress;
  return 1;
}

static int null_is_refused(freqsynth_synthesizer* engine) {
  freqsynth_request request;
  freqsynth_image* image = NULL;
  freqsynth_stats stats;
  float value = 0;
  size_t count;
  int32_t number;
  freqsynth_pixels view = {NULL, 8, 8, 0, 0, 0};
  stats.struct_size = sizeof stats;
  REFUSED(freqsynth_synthesizer_create(NULL, NULL), "synthesizer is NULL");
  REFUSED(freqsynth_list_create(NULL, NULL), "list is NULL");
  REFUSED(freqsynth_thread_pool_create(1, NULL), "pool is NULL");
  REFUSED(freqsynth_thread_pool_create(100000, (freqsynth_thread_pool**)&image), "threads");
  CHECK(image == NULL);
  REFUSED(freqsynth_set_stop(NULL, NULL), "synthesizer is NULL");
  REFUSED(freqsynth_request_samples(NULL, &request, 1, 0, &count), "synthesizer is NULL");
  REFUSED(freqsynth_request_samples(engine, NULL, 1, 0, &count), "requests is NULL");
  REFUSED(freqsynth_request_samples(engine, &request, 1, 0, NULL), "count is NULL");
  REFUSED(freqsynth_request_samples(engine, &request, 1, 2, &count), "wait is 2, not in 0..1");
  REFUSED(freqsynth_deliver(engine, NULL, 1, &value, 0), "requests is NULL");
  REFUSED(freqsynth_deliver(engine, &request, 1, NULL, 0), "values is NULL");
  OK(freqsynth_deliver(engine, NULL, 0, NULL, 0));
  REFUSED(freqsynth_give_back(engine, NULL, 1), "requests is NULL");
  REFUSED(freqsynth_abandon(engine, NULL, 1), "requests is NULL");
  REFUSED(freqsynth_cancel(NULL), "synthesizer is NULL");
  REFUSED(freqsynth_stopped(engine, NULL), "reason is NULL");
  REFUSED(freqsynth_wave_size(engine, NULL), "size is NULL");
  REFUSED(freqsynth_get_progress(engine, NULL), "progress is NULL");
  REFUSED(freqsynth_get_stats(engine, NULL), "stats is NULL");
  REFUSED(freqsynth_get_stats(NULL, &stats), "synthesizer is NULL");
  REFUSED(freqsynth_get_bad_samples(engine, NULL, 1, &count), "samples is NULL");
  REFUSED(freqsynth_is_noisy(NULL, &number), "synthesizer is NULL");
  REFUSED(freqsynth_set_importance(engine, NULL, 4), "importance is NULL");
  REFUSED(freqsynth_run(engine, NULL, NULL, NULL), "sampler is NULL");
  REFUSED(freqsynth_finish(engine, NULL, NULL, NULL), "pixels is NULL");
  REFUSED(freqsynth_finish(engine, NULL, NULL, &view), "no memory for 8 x 8 pixels");
  REFUSED(freqsynth_channel_pixels(engine, 0, NULL), "pixels is NULL");
  REFUSED(freqsynth_error_image(engine, NULL, NULL), "pixels is NULL");
  REFUSED(freqsynth_predicted_rmse(engine, NULL, NULL), "rmse is NULL");
  REFUSED(freqsynth_fitted_image(engine, NULL), "image is NULL");
  REFUSED(freqsynth_finished_image(NULL, NULL, &image), "synthesizer is NULL");
  REFUSED(freqsynth_image_get_info(NULL, NULL), "image is NULL");
  REFUSED(freqsynth_image_get_block(NULL, 0, 0, 0, NULL, NULL), "image is NULL");
  REFUSED(freqsynth_reconstruct(NULL, NULL, &view), "image is NULL");
  REFUSED(freqsynth_evaluate(NULL, NULL, 0, 0, &value, 1), "image is NULL");
  REFUSED(freqsynth_image_save(NULL, "nowhere"), "image is NULL");
  REFUSED(freqsynth_image_load(NULL, &image), "file is NULL");
  FAILS(freqsynth_image_load("/nonexistent/file", &image), FREQSYNTH_SYSTEM_ERROR, "/nonexistent");
  CHECK(image == NULL);
  freqsynth_synthesizer_destroy(NULL);
  freqsynth_image_destroy(NULL);
  freqsynth_list_destroy(NULL);
  freqsynth_thread_pool_destroy(NULL);
  freqsynth_settings_init(NULL, 100);
  return 0;
}

static int settings_are_refused(void) {
  freqsynth_settings settings;
  freqsynth_synthesizer* engine = NULL;
  freqsynth_channel channels[3] = {{FREQSYNTH_ROLE_STEER, 1}, {9, 1}, {FREQSYNTH_ROLE_STEER, 1}};
  freqsynth_stop_rule rule;
  memset(&settings, 0, sizeof settings);
  REFUSED(freqsynth_synthesizer_create(&settings, &engine),
          "settings.struct_size is 0, not set by");
  freqsynth_settings_init(&settings, sizeof settings);
  settings.channels = 0;
  REFUSED(freqsynth_synthesizer_create(&settings, &engine), "has no channel");
  settings.channels = 3;
  settings.priority_decay = NAN;
  REFUSED(freqsynth_synthesizer_create(&settings, &engine), "decay is nan");
  settings.priority_decay = 0.5;
  settings.noise = 3;
  REFUSED(freqsynth_synthesizer_create(&settings, &engine), "noise is 3, not in 0..2");
  settings.noise = -1;
  REFUSED(freqsynth_synthesizer_create(&settings, &engine), "noise is -1, not in 0..2");
  settings.noise = FREQSYNTH_NOISE_NONE;
  settings.list_positions = 2;
  REFUSED(freqsynth_synthesizer_create(&settings, &engine), "list_positions is 2");
  settings.list_positions = 0;
  settings.priority_measure = 2;
  REFUSED(freqsynth_synthesizer_create(&settings, &engine), "priority_measure is 2");
  settings.priority_measure = 0;
  settings.priority_steer = 3;
  REFUSED(freqsynth_synthesizer_create(&settings, &engine), "priority_steer is 3");
  settings.priority_steer = 0;
  settings.refiner = 2;
  REFUSED(freqsynth_synthesizer_create(&settings, &engine), "refiner is 2, not in 0..1");
  settings.refiner = FREQSYNTH_REFINER_LEAST_SQUARES;
  settings.packet = 0;
  REFUSED(freqsynth_synthesizer_create(&settings, &engine), "packet is 0, not in 1..1048576");
  settings.packet = 1;
  settings.channel_settings = channels;
  REFUSED(freqsynth_synthesizer_create(&settings, &engine), "role is 9, not in 0..5");
  settings.channel_settings = NULL;
  settings.importance_count = 4;
  REFUSED(freqsynth_synthesizer_create(&settings, &engine), "importance is NULL");
  CHECK(engine == NULL);
  settings.importance_count = 0;
  OK(freqsynth_synthesizer_create(&settings, &engine));
  freqsynth_stop_rule_init(&rule, sizeof rule);
  rule.samples_per_pixel = NAN;
  REFUSED(freqsynth_set_stop(engine, &rule), "samples_per_pixel is nan");
  freqsynth_synthesizer_destroy(engine);
  return 0;
}

static int runs_are_refused(freqsynth_synthesizer* engine) {
  freqsynth_run_options options;
  freqsynth_run_report report;
  freqsynth_executor executor = {NULL, 2, NULL};
  freqsynth_thread_pool* pool = NULL;
  freqsynth_stop_rule rule;
  freqsynth_stats stats;
  uint64_t before;
  int calls = 0;
  freqsynth_stop_rule_init(&rule, sizeof rule);
  rule.samples = 1500;
  freqsynth_run_options_init(&options, sizeof options);
  options.sampler = fail;
  options.sampler_user = &calls;
  options.executor = &executor;
  REFUSED(freqsynth_run(engine, &rule, &options, NULL), "executor.execute is NULL");
  executor.execute = refuse_to_execute;
  FAILS(freqsynth_run(engine, &rule, &options, NULL), FREQSYNTH_CALLBACK_FAILED,
        "the executor returned -5");
  OK(freqsynth_thread_pool_create(2, &pool));
  options.thread_pool = pool;
  REFUSED(freqsynth_run(engine, &rule, &options, NULL), "both an executor and a thread_pool");
  options.executor = NULL;
  options.thread_pool = NULL;
  freqsynth_thread_pool_destroy(pool);
  report.struct_size = 0;
  REFUSED(freqsynth_run(engine, &rule, &options, &report), "report.struct_size is 0");
  options.batch = 0;
  REFUSED(freqsynth_run(engine, &rule, &options, NULL), "batch");
  options.batch = 64;

  /* What came before the failure is kept, and the run can go on. */
  CHECK(calls == 0);
  FAILS(freqsynth_run(engine, &rule, &options, NULL), FREQSYNTH_CALLBACK_FAILED,
        "the sampler returned 42");
  CHECK(calls == 3);
  stats.struct_size = sizeof stats;
  OK(freqsynth_get_stats(engine, &stats));
  before = stats.samples;
  CHECK(before > 0 && before < 1500);
  options.progress = stop_at_once;
  report.struct_size = sizeof report;
  OK(freqsynth_run(engine, &rule, &options, &report));
  CHECK(report.reason == FREQSYNTH_STOP_CANCELLED);
  options.progress = NULL;
  OK(freqsynth_run(engine, &rule, &options, &report));
  CHECK(report.reason == FREQSYNTH_STOP_SAMPLES);
  OK(freqsynth_get_stats(engine, &stats));
  CHECK(stats.samples >= 1500);
  return 0;
}

static int values_are_refused(freqsynth_synthesizer* engine) {
  freqsynth_request requests[2];
  freqsynth_image* image = NULL;
  freqsynth_reconstruction_settings how;
  freqsynth_finish_settings finish;
  float values[2] = {1, 1}, pixels[64];
  freqsynth_pixels view = {NULL, 8, 8, 0, 0, 0};
  size_t count;
  view.data = pixels;
  OK(freqsynth_set_stop(engine, NULL));
  OK(freqsynth_request_samples(engine, requests, 2, 0, &count));
  CHECK(count == 2);
  OK(freqsynth_deliver(engine, requests, 1, values, 0));
  REFUSED(freqsynth_deliver(engine, requests, 2, values, 0), "is not owed");
  OK(freqsynth_give_back(engine, requests + 1, 1));
  REFUSED(freqsynth_channel_pixels(engine, 0, &view), "pixels has 8 x 8 pixels, not 32 x 24");
  REFUSED(freqsynth_error_image(engine, NULL, &view), "pixels has 8 x 8 pixels, not 32 x 24");
  view.width = 4;
  view.pixel_stride = view.row_stride = 3;
  REFUSED(freqsynth_finish(engine, NULL, NULL, &view), "values would share memory");
  view.pixel_stride = view.row_stride = 0;
  OK(freqsynth_fitted_image(engine, &image));
  REFUSED(freqsynth_image_get_block(image, 4, 0, 0, NULL, NULL), "no channel 0 of a block (4, 0)");
  REFUSED(freqsynth_image_get_block(image, 0, 3, 0, NULL, NULL), "of a block (0, 3)");
  REFUSED(freqsynth_image_get_block(image, 0, 0, 1, NULL, NULL), "no channel 1");
  REFUSED(freqsynth_evaluate(image, NULL, 99, 0, values, 1), "is not in the image");
  REFUSED(freqsynth_evaluate(image, NULL, 1, 1, values, 2), "room for 2 of 1 channels");
  freqsynth_reconstruction_settings_init(&how, sizeof how);
  how.pixel_filter = 6;
  REFUSED(freqsynth_reconstruct(image, &how, &view), "pixel_filter is 6, not in 0..5");
  how.pixel_filter = FREQSYNTH_FILTER_TENT;
  how.filter_radius = -1;
  REFUSED(freqsynth_reconstruct(image, &how, &view), "filter_shape.radius is -1");
  how.filter_radius = 0;
  how.butterworth_cutoff = NAN;
  REFUSED(freqsynth_reconstruct(image, &how, &view), "cutoff is nan");
  freqsynth_finish_settings_init(&finish, sizeof finish);
  finish.slack = -1;
  REFUSED(freqsynth_finish(engine, &finish, NULL, &view), "slack is -1");
  FAILS(freqsynth_image_save(image, "/nonexistent/file"), FREQSYNTH_SYSTEM_ERROR, "/nonexistent");
  freqsynth_image_destroy(image);
  return 0;
}

int host_is_refused(void) {
  freqsynth_settings settings;
  freqsynth_synthesizer* engine = NULL;
  int line;
  CHECK(strcmp(freqsynth_last_error(), "") == 0);
  line = settings_are_refused();
  if (line != 0) return line;
  freqsynth_settings_init(&settings, sizeof settings);
  settings.width = 32;
  settings.height = 24;
  settings.channels = 1;
  settings.wave = 4;
  OK(freqsynth_synthesizer_create(&settings, &engine));
  line = null_is_refused(engine);
  if (line == 0) line = runs_are_refused(engine);
  if (line == 0) line = values_are_refused(engine);
  freqsynth_synthesizer_destroy(engine);
  return line;
}
