// SPDX-License-Identifier: MIT
/// \file
/// The engine (paper, section 4): chooses positions, takes values, refines blocks. It is made of
/// parts that can be used alone: the grid, the store of blocks, the cache of border samples, the
/// wave, the signal's statistics and the choice of blocks.
///
/// It knows neither what estimates a block (a Refiner) nor what makes a block worth a sample (a
/// BlockMeasure), and nothing of images. Hosts use it through Synthesizer.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <mutex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "freqsynth/basis/check.h"
#include "freqsynth/basis/config.h"
#include "freqsynth/engine/block_choice.h"
#include "freqsynth/engine/block_grid.h"
#include "freqsynth/engine/block_measure.h"
#include "freqsynth/engine/block_snapshot.h"
#include "freqsynth/engine/block_store.h"
#include "freqsynth/engine/channel_settings.h"
#include "freqsynth/engine/channel_units.h"
#include "freqsynth/engine/edge_cache.h"
#include "freqsynth/engine/executor.h"
#include "freqsynth/engine/exploration.h"
#include "freqsynth/engine/host_desk.h"
#include "freqsynth/engine/noise.h"
#include "freqsynth/engine/noise_probes.h"
#include "freqsynth/engine/signal_statistics.h"
#include "freqsynth/engine/stop_rule.h"
#include "freqsynth/engine/team_work.h"
#include "freqsynth/engine/visit_plan.h"
#include "freqsynth/engine/wave.h"
#include "freqsynth/refine/refiner.h"
#include "freqsynth/sampler.h"

namespace freqsynth {

/// All members may be called from any thread. Each does all that it says or, when it throws,
/// nothing: what was delivered is never lost.
template <Refiner R, BlockMeasure<R> M>
class Engine : public HostDesk<Engine<R, M>> {
 public:
  /// \param factors      factor on the priority of each block of the grid
  /// \param wave         most blocks of a wave; 1: one sample of one block; 0: 1/32 of all blocks
  /// \param exploration  see PrioritySettings::exploration
  /// \param seed         of Request::seed
  /// \param noise        whether `measure` is to be told of noise once it is seen
  /// \param apart        roles of the channels that come after those of the blocks, see PixelStore
  /// \param first        samples that every block gets before errors decide
  Engine(const BlockGrid& grid, BlockStore<R> blocks, M measure, std::vector<float> factors,
         std::size_t wave, double exploration = 0, std::uint64_t seed = 0,
         Noise noise = Noise::none, std::span<const ChannelRole> apart = {}, std::size_t first = 0);

  /// Tells the error to expect of finished pixels, from the blocks and whether they are noisy.
  using Predictor = double (*)(const void* context, const BlockGrid& grid,
                               const BlockSnapshot<R>& blocks, bool noisy);
  /// Sets what StopRule::target_rmse is compared with. Without it that rule never holds.
  /// \param context  handed on to `predict`; must live as long as the engine
  void use_predictor(Predictor predict, const void* context) {
    predict_ = predict;
    context_ = context;
  }

  /// Other factors on the priorities, one for each block, from the next wave on.
  void set_factors(std::vector<float> factors);
  /// Most positions that request() hands out before values have to come back.
  [[nodiscard]] std::size_t wave_size() const {
    const std::size_t most = wave_size_ * longest_visit_;
    return most + NoiseProbes::most(most);
  }
  /// Calls read(grid, blocks) with the blocks after the last complete wave, which stay as they are
  /// meanwhile.
  template <class Read>
  auto read(Read&& read) const {
    const std::unique_lock lock = settled();
    return read(grid_, blocks_);
  }
  /// Calls use(grid, snapshot, noisy()) with a BlockSnapshot of the blocks after the last complete
  /// wave, while others go on sampling. One such call waits for another. \throws std::bad_alloc,
  /// and what `use` throws.
  /// \param features  receives before a copy of the channels of ChannelRole::mean_feature
  template <class Use>
  auto with_snapshot(Use&& use, std::optional<PixelStore>* features = nullptr) const;

  /// Saves all that is known, requests that are owed included, into an archive; see StateArchive.
  template <class Archive>
  void save(Archive& archive) const {
    const std::unique_lock lock = settled();
    list_parts(archive, *this);
  }
  /// Loads it, into an engine that is as new. What was owed is handed out again. When it throws,
  /// the engine must not be used.
  template <class Archive>
  void load(Archive& archive) {
    const std::unique_lock lock = settled();
    list_parts(archive, *this);
  }

 private:
  using Desk = HostDesk<Engine>;
  friend Desk;
  using Desk::apart_;
  using Desk::ended_;
  using Desk::errors_;
  using Desk::grid_;
  using Desk::mutex_;
  using Desk::noise_;
  using Desk::pixels_;
  using Desk::reason;
  using Desk::room_;
  using Desk::stats_;
  using Desk::stop_;
  using Desk::wave_;

  /// Waves of fewer visits are not worth the trouble of sharing them.
  static constexpr std::size_t least_shared = 128;
  /// A visit of more samples, which is rare, is no affair of several threads.
  static constexpr std::size_t most_apart = 16;

  [[nodiscard]] std::unique_lock<std::mutex> settled() const;
  // All of these run under the lock, but where they say otherwise.
  [[nodiscard]] BlockView<R> view() const { return {grid_, blocks_, signal_}; }
  [[nodiscard]] const SequencePosition& position(std::size_t index) const {
    return blocks_.refiner().list().position(index);
  }
  void use_factors();
  [[nodiscard]] double share_of_blocks() const;
  [[nodiscard]] bool meets_target();
  template <class Archive, class Self>
  static void list_parts(Archive& archive, Self& self);
  template <class Archive, class Self>
  static void list_wave(Archive& archive, Self& self);
  std::optional<StopReason> prepare_wave();
  std::optional<StopReason> choose_wave();
  /// How much may be chosen for a wave.
  struct Portion {
    std::size_t blocks = 0;  // that are visited
    std::size_t visit = 0;   // samples of each
  };
  [[nodiscard]] Portion portion() const;
  void reserve(const Portion& most);
  void choose(std::uint32_t block, std::size_t samples);
  void choose_lagging(const Portion& most);
  void choose_least_sampled(const Portion& most);
  // What the chosen blocks ask for; see engine_plan.inl.
  void plan_visits();
  [[nodiscard]] std::uint32_t asked_end(std::uint32_t block) const;
  void lengthen(std::uint32_t block);
  void ask(Visit& visit);
  ValueSource source_of(std::uint32_t block, std::uint32_t index);
  [[nodiscard]] Request make_request(std::uint32_t slot) const;
  void change_units();
  void note(std::size_t slot);
  // How a wave is taken in; see engine_absorb.inl.
  /// What threads do together, without the lock; all else is done by one of them, under it.
  enum class Stage { absorb, revise };
  /// What is noted of a visit.
  struct Taken {
    double sum = 0;     // see BlockMeasure::add()
    bool done = false;  // apart from the others
  };
  void end_of_delivery(std::unique_lock<std::mutex>& lock, const detail::ExecutorRef& executor);
  void work_together(const detail::ExecutorRef& executor);
  [[nodiscard]] static std::size_t ranges(std::size_t visits);
  void begin_stage(Stage stage);
  void work(std::size_t piece);
  std::size_t next_stage();
  void absorb_all();
  void finish_wave();
  void end_wave();
  void prefetch(std::size_t visit, std::size_t end) const;
  void take_known();
  [[nodiscard]] const float* values_of(const Visit& visit, std::size_t i) const;
  [[nodiscard]] std::span<float> squares_of(std::size_t visit) {
    const std::size_t size = 2 * blocks_.refiner().channels();
    return {squares_.data() + visit * size, size};
  }
  void absorb(const Visit& visit);
  void absorb_apart(std::size_t number, AbsorbRoom& room);
  void join();
  void keep_for_others();

  BlockStore<R> blocks_;
  EdgeCache cache_;
  ChannelUnits units_;
  SignalStatistics signal_;
  BlockChoice<R, M> choice_;
  VisitPlan plan_;                      // of the wave
  std::vector<std::uint32_t> borders_;  // slots whose position other blocks have, too
  struct Known {
    std::uint32_t block, index;
  };
  std::vector<Known> known_;    // samples that the cache has
  std::vector<float> changes_;  // of the samples of a visit
  // While a wave is taken in, of each visit, and room for each range of them:
  Stage stage_ = Stage::absorb;
  bool others_ = false;  // all priorities change
  std::vector<Taken> taken_;
  std::vector<float> squares_;
  std::vector<Revision> revisions_;
  std::vector<AbsorbRoom> rooms_;
  mutable detail::TeamWork team_;
  std::uint64_t frame_;        // the seed, mixed
  std::size_t wave_size_;      // blocks
  std::size_t longest_visit_;  // samples
  Exploration exploration_;
  double shares_ = 0;                          // of all blocks, see BlockChoice::share()
  std::optional<std::vector<float>> factors_;  // that are to be used from the next wave on
  Predictor predict_ = nullptr;
  const void* context_ = nullptr;
  mutable std::mutex snapshot_;  // of which there is one at a time; locked before the other
};

}  // namespace freqsynth

#include "freqsynth/engine/engine.inl"
