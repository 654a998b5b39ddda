// SPDX-License-Identifier: MIT
#include "mail.h"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

namespace farm {

Mail::Mail(MPI_Comm ranks) : comm_(ranks) {
  MPI_Comm_rank(comm_, &rank_);
  MPI_Comm_size(comm_, &ranks_);
}

Mail::~Mail() {
  while (!leaving_.empty()) {
    keep_going();
    rest(true);
  }
}

std::vector<std::byte> Mail::paper() {
  if (buffers_.empty()) return {};
  std::vector<std::byte> bytes = std::move(buffers_.back());
  buffers_.pop_back();
  bytes.clear();
  return bytes;
}

void Mail::send(int to, int kind, std::vector<std::byte>&& bytes) {
  Transfer& transfer = leaving_.emplace_back();
  transfer.letter = {to, kind, std::move(bytes)};
  MPI_Isend(transfer.letter.bytes.data(), static_cast<int>(transfer.letter.bytes.size()), MPI_BYTE,
            to, kind, comm_, &transfer.request);
}

void Mail::keep_going() {
  for (;;) {
    int has_come = 0;
    MPI_Message message = MPI_MESSAGE_NULL;
    MPI_Status status;
    MPI_Improbe(MPI_ANY_SOURCE, MPI_ANY_TAG, comm_, &has_come, &message, &status);
    if (has_come == 0) break;
    int size = 0;
    MPI_Get_count(&status, MPI_BYTE, &size);
    Transfer& transfer = coming_.emplace_back();
    transfer.letter = {status.MPI_SOURCE, status.MPI_TAG, paper()};
    transfer.letter.bytes.resize(static_cast<std::size_t>(size));
    MPI_Imrecv(transfer.letter.bytes.data(), size, MPI_BYTE, &message, &transfer.request);
  }
  for (auto transfer = leaving_.begin(); transfer != leaving_.end();) {
    int done = 0;
    MPI_Test(&transfer->request, &done, MPI_STATUS_IGNORE);
    if (done == 0) {
      ++transfer;
      continue;
    }
    recycle(std::move(transfer->letter.bytes));
    transfer = leaving_.erase(transfer);
  }
}

std::optional<Letter> Mail::look() {
  keep_going();
  if (coming_.empty()) return std::nullopt;
  int done = 0;
  MPI_Test(&coming_.front().request, &done, MPI_STATUS_IGNORE);
  if (done == 0) return std::nullopt;
  Letter letter = std::move(coming_.front().letter);
  coming_.pop_front();
  return letter;
}

Letter Mail::wait() {
  for (;;) {
    if (std::optional<Letter> letter = look()) {
      rest(false);
      return std::move(*letter);
    }
    rest(true);
  }
}

void Mail::rest(bool idle) {
  constexpr unsigned tries = 200;
  if (!idle) {
    idle_ = 0;
  } else if (++idle_ < tries) {
    std::this_thread::yield();
  } else {
    std::this_thread::sleep_for(std::chrono::microseconds(std::min(idle_ - tries + 5, 100u)));
  }
}

}  // namespace farm
