#ifndef HINDSIGHT_IO_CONFIG_LOAD_STREAMS_H_
#define HINDSIGHT_IO_CONFIG_LOAD_STREAMS_H_

#include <atomic>
#include <cstddef>
#include <future>
#include <vector>

#include "dataset/dataset.h"
#include "io/config/config_map.h"
#include "io/config/config_recording.h"

namespace hindsight {

/// Rows of a file before they are placed on the recording's time.
template <typename Series>
struct RowsOfFile {
  Series rows;
  StreamClock clock;
  std::vector<PolicyCount> policies;
};

/// The truth and the aiding streams of a declared recording, read one after the
/// other beside the IMU, whose time they need only when they are placed.
class StreamsBeside {
 public:
  /// `declared` must outlive the object.
  explicit StreamsBeside(const DeclaredRecording& declared);
  /// Reads on no more.
  ~StreamsBeside() { abandoned_ = true; }
  StreamsBeside(const StreamsBeside&) = delete;
  StreamsBeside& operator=(const StreamsBeside&) = delete;

  /// Of the declared truth, once. Throws InputError for what the reader refuses.
  RowsOfFile<TruthSeries> Truth();
  /// Of the aiding stream of that index, which is not generated, as above.
  RowsOfFile<MeasurementSeries> Aiding(std::size_t index);

 private:
  StreamSource Abandonable(StreamSource source) const;

  std::packaged_task<RowsOfFile<TruthSeries>()> truth_;
  std::vector<std::packaged_task<RowsOfFile<MeasurementSeries>()>> aiding_;
  std::atomic<bool> abandoned_ = false;
  std::future<void> reading_;  ///< the last member: it waits
};

/// The streams of a declared recording, from their files onto its time.
/// Each throws InputError for what a reader refuses, and for a stream that does
/// not overlap with the IMU's.

/// The IMU and, where the configuration gives none, the epoch, which are written
/// into `top` as resolved.
void LoadImu(const DeclaredRecording& declared, ConfigMap* top,
             Dataset* dataset);

/// The truth, if one is declared; gives the time offset of its stamps [s].
double LoadTruth(const DeclaredRecording& declared, StreamsBeside* beside,
                 Dataset* dataset);

/// All aiding streams, in their order, and behind them the priors "level on
/// average" of those that have one.
void LoadAidingStreams(const DeclaredRecording& declared, double truth_offset,
                       StreamsBeside* beside, Dataset* dataset);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_CONFIG_LOAD_STREAMS_H_
