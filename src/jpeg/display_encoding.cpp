#include "freqsynth/jpeg/display_encoding.inl"
