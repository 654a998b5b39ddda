#include "freqsynth/refine/literal_refiner.inl"
