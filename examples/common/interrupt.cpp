// SPDX-License-Identifier: MIT
#include "interrupt.h"

#include <signal.h>

#include <array>
#include <atomic>

namespace {

constexpr std::array noted_signals{SIGINT, SIGTERM};

std::atomic<int> noted{0};
static_assert(std::atomic<int>::is_always_lock_free, "a handler sets it");

void act_on_signals(void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;  // the scene's reading and writing goes on
  for (const int number : noted_signals) sigaddset(&action.sa_mask, number);
  for (const int number : noted_signals) sigaction(number, &action, nullptr);
}

/// Of whichever thread was chosen.
void note(int number) {
  noted.store(number);
  act_on_signals(SIG_DFL);
}

}  // namespace

void note_interrupts() { act_on_signals(note); }

int noted_interrupt() { return noted.load(); }
