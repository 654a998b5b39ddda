#include "freqsynth/jpeg/quantization_tables.inl"
