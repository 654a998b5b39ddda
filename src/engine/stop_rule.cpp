#include "freqsynth/engine/stop_rule.inl"
