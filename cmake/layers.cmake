# The layer table: the one list of the library's headers. The build installs exactly these (jpeg.h
# with its component), and check_layers.cmake lets each include only headers of a strictly lower
# layer.
set(FREQSYNTH_LAYERS
  "0 config.h"
  "1 dct.h"
  "1 sample_sequence.h"
  "1 sampler.h"
  "1 executor.h"
  "1 detail/kernels.h"
  "2 normal_inverse.h"
  "3 inverse_list.h"
  "3 frequency_image.h"
  "4 least_squares_refiner.h"
  "4 priority.h"
  "4 block_queue.h"
  "4 edge_cache.h"
  "5 butterworth.h"
  "5 quantization_target.h"
  "6 pixel_finisher.h"
  "7 synthesizer.h"
  "6 reconstructor.h"
  "6 quantization.h"
  "7 display_encoding.h"
  "7 jpeg.h"
  "8 freqsynth.h"
)
