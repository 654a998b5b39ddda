#include "freqsynth/refine/least_squares_refiner.inl"
