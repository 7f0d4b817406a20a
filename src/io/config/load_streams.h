#ifndef HINDSIGHT_IO_CONFIG_LOAD_STREAMS_H_
#define HINDSIGHT_IO_CONFIG_LOAD_STREAMS_H_

#include "dataset/dataset.h"
#include "io/config/config_map.h"
#include "io/config/config_recording.h"

namespace hindsight {

/// The streams of a declared recording, from their files onto its time.
/// Each throws InputError for what a reader refuses, and for a stream that does
/// not overlap with the IMU's.

/// The IMU and, where the configuration gives none, the epoch, which are written
/// into `top` as resolved.
void LoadImu(const DeclaredRecording& declared, ConfigMap* top,
             Dataset* dataset);

/// The truth, if one is declared; gives the time offset of its stamps [s].
double LoadTruth(const DeclaredRecording& declared, Dataset* dataset);

/// All aiding streams, in their order, and behind them the priors "level on
/// average" of those that have one.
void LoadAidingStreams(const DeclaredRecording& declared, double truth_offset,
                       Dataset* dataset);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_CONFIG_LOAD_STREAMS_H_
