# The layer table: the one list of the library's headers, lowest first, each as
#   header | what it does | section of the paper
# The build installs exactly these (jpeg/jpeg.h with its component), check_layers.cmake lets each
# include only headers that stand above it, and the README's table is made from it.
set(FREQSYNTH_LAYERS
  "basis/config.h|version, block size, assertion|"
  "basis/float_bits.h|what kind of number a value is, also under -ffast-math|"
  "basis/check.h|how arguments are refused|"
  "basis/aligned.h|memory that starts on a cache line|"
  "basis/kernels.h|the vectorised inner loops|"
  "basis/dct.h|cosine terms at any point, zig-zag order, forward and inverse transform|2, eqs. 1, 2, 34"
  "basis/sample_sequence.h|the quad-tree order of samples, and which sample is whose partner across an edge|4.3.1"
  "basis/normal_inverse.h|J and its inverse, growing: Powell's rank-one update, Frobenius bordering|4.1.2, 4.2"
  "basis/inverse_list.h|the shared list: position, J^-1, gain for every index|4.3"
  "sampler.h|what a radiance function looks like, and requests|"
  "refine/least_squares_refiner.h|takes the next value of a block into its coefficients|4.1, 4.2"
  "engine/executor.h|how `run` uses threads, a thread pool|"
  "engine/block_grid.h|the blocks of an image|"
  "engine/block_queue.h|which block is first|4.4"
  "engine/edge_cache.h|samples on borders, taken once for two or four blocks|4.3.1"
  "engine/priority.h|how much a block deserves the next sample|4.4"
  "image/butterworth.h|the low-pass filter against what aliasing is left|4.5"
  "image/frequency_image.h|the result: coefficients and sample counts per block|4"
  "image/pixel_finisher.h|finished pixels: the fit and what it leaves over (beyond the paper)|"
  "image/reconstructor.h|frequency image to pixels of any size, or to a value at a point|4.5"
  "jpeg/quantization_target.h|a stop rule and priority for a synthesis that ends in a quantiser|1, 2, 6"
  "jpeg/quantization.h|JPEG tables, quantised blocks, chroma at half the resolution|2, eq. 3"
  "jpeg/display_encoding.h|linear radiance to the signal of a JPEG file, per sample or per pixel|2"
  "jpeg/jpeg.h|component `freqsynth::jpeg`: quantised blocks to a JPEG file and back, with libjpeg|2"
  "synthesizer.h|the engine: request, deliver, run|4"
  "freqsynth.h|all of them but `jpeg/jpeg.h`|"
)
