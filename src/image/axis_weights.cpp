#include "freqsynth/image/axis_weights.inl"
