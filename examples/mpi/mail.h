// SPDX-License-Identifier: MIT
/// \file
/// Letters between ranks: bytes with a kind, sent and received while work goes on.
#pragma once

#include <mpi.h>

#include <cstddef>
#include <deque>
#include <list>
#include <optional>
#include <utility>
#include <vector>

namespace farm {

/// What a letter holds. Those of work are numbered from `work` on.
enum Kind : int { end_of_work, answer, window_task, window_picture, work };

/// A letter that has come.
struct Letter {
  int from = 0;
  int kind = 0;
  std::vector<std::byte> bytes;
};

/// The mail of a rank, for one thread. Nothing is copied but by MPI, and buffers are used again.
class Mail {
 public:
  explicit Mail(MPI_Comm ranks);
  Mail(const Mail&) = delete;
  Mail& operator=(const Mail&) = delete;
  /// Waits until all letters have left.
  ~Mail();

  [[nodiscard]] int rank() const { return rank_; }
  [[nodiscard]] int ranks() const { return ranks_; }

  /// An empty buffer for a letter.
  [[nodiscard]] std::vector<std::byte> paper();
  /// Sends a letter; it may take until later calls.
  void send(int to, int kind, std::vector<std::byte>&& bytes);
  /// Lets letters go on coming and leaving; to be called between pieces of other work.
  void keep_going();
  /// The next letter that has come, if any. Those of a rank come in their order.
  [[nodiscard]] std::optional<Letter> look();
  /// Waits for the next letter.
  [[nodiscard]] Letter wait();
  /// Takes the buffer of a letter back.
  void recycle(std::vector<std::byte>&& bytes) { buffers_.push_back(std::move(bytes)); }
  /// Rests for a moment when there is nothing to do, the longer the more often in a row.
  void rest(bool idle);

 private:
  struct Transfer {
    Letter letter;
    MPI_Request request = MPI_REQUEST_NULL;
  };

  MPI_Comm comm_;
  int rank_ = 0, ranks_ = 1;
  unsigned idle_ = 0;  // times in a row
  std::deque<Transfer> coming_;
  std::list<Transfer> leaving_;
  std::vector<std::vector<std::byte>> buffers_;
};

}  // namespace farm
