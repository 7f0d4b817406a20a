#ifndef HINDSIGHT_IO_READ_OXTS_H_
#define HINDSIGHT_IO_READ_OXTS_H_

#include <string>
#include <vector>

#include "io/read/row_buffer.h"

namespace hindsight {

/// Reads an "oxts" folder of the KITTI recordings: timestamps.txt, one date and
/// time a line, taken as UTC, and beside it data/, one file with 30 values an
/// epoch, in the order of their names. What comes out has body axes
/// forward-right-down and north-east-down:
///   imu       ax ay az, wx wy wz (vehicle axes forward-left-up; af al au and
///             wf wl wu are levelled and no strapdown reading), y and z negated
///   position  lat lon alt, pos_accuracy as each standard deviation, posmode as
///             quality
///   velocity  vn, ve, -vu, vel_accuracy, velmode
///   truth     these and roll, -pitch, 90 deg - yaw (yaw is 0 east,
///             counter-clockwise; pitch is positive nose down)
/// Stamps are GPS time. The first line's file is data/0000000000.txt, and
/// numbers go on by one a line. An epoch that is missing is an empty line and
/// no file; how many, the rows say. Throws InputError, naming the epoch's file,
/// for another number of values, text and further lines, and naming the stamp's
/// line if it has no file or a file has no stamp.
RowBuffer ReadOxts(const std::string& folder,
                   const std::vector<FieldName>& fields);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_OXTS_H_
