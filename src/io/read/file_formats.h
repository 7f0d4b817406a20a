#ifndef HINDSIGHT_IO_READ_FILE_FORMATS_H_
#define HINDSIGHT_IO_READ_FILE_FORMATS_H_

#include "io/read/file_format.h"

namespace hindsight {

/// The own CSV, docs/formats.md. It is a truth only by its file's name.
const FileFormat& CsvFormat();

/// Delimited text whose columns the configuration declares.
const FileFormat& ColumnsFormat();

/// RTKLIB solutions (.pos) in latitude, longitude (deg) and height, as their
/// column header says, the last line that starts with '%'. Time is GPST or UTC,
/// as the header says, as a date or as week and seconds of week. East-north-up
/// values become north-east-down: sigma_d = sdu, v_d = -vu, and the signed
/// square roots of covariances with "up" change sign.
const FileFormat& RtklibPosFormat();

/// KF-GINS and OB_GINS text without a header:
///   imu       t dtheta(3) [rad] dvel(3) [m/s]
///   odometer  t and the speed [m/s] in column 8 of the same file
///   truth     week t lat lon [deg] h v_n v_e v_d roll pitch heading [deg]
///   position  t lat lon [deg] h sigma_n sigma_e sigma_d
const FileFormat& KfGinsFormat();

/// EuRoC MAV, body to world in the truth:
///   imu    t [ns] gyro(3) [rad/s] accel(3) [m/s^2]
///   truth  t [ns] position(3) [m] quaternion w x y z, velocity(3)
const FileFormat& EurocFormat();

/// NCLT, without a header:
///   imu (ms25.csv)  t [us] field(3) accel(3) gyro(3)
///   gps.csv         t [us] mode satellites lat lon [rad] h [m] course [rad]
///                   speed [m/s], the mode as quality
const FileFormat& NcltFormat();

/// t lat lon [deg] h sigma [m], one sigma for three axes.
const FileFormat& ControlPointsFormat();

/// An "oxts" folder of the KITTI recordings: timestamps.txt, one date and time
/// a line, taken as UTC, and beside it data/, one file with 30 values an epoch,
/// in the order of their names. What comes out has body axes
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
const FileFormat& OxtsFormat();

/// NMEA 0183 sentences of any talker. Streams with a position or a height take
/// GGA: the height above the ellipsoid is the height above mean sea level plus
/// the geoid separation, the standard deviations are those of GST when every
/// fix has one, quality is GGA's, and so are the satellites where every fix
/// tells them. Streams of speed and course take RMC: speed over the ground from
/// knots, course absent where the receiver gives none. Sentences without a fix
/// are left out and counted, other sentences are passed over. Time of day is
/// UTC and continues over midnight; the date is that of RMC or ZDA: with one,
/// stamps are GPS time; else they are seconds of the first day. Throws
/// InputError for a wrong or missing checksum, a line that is no sentence and
/// values out of range.
const FileFormat& NmeaFormat();

/// The points of all tracks of a GPX file, in the order of the file: lat, lon, and
/// ele as the height, which by GPX's definition is above the sea. A file in which
/// no point has an ele has heights of 0 m. Times are UTC; stamps are GPS time.
/// Points without a time are left out and counted. Throws InputError, naming the
/// line, for what is no XML, times that are none, a height that is missing in some
/// points, and values out of range.
const FileFormat& GpxFormat();

/// NumPy arrays, one file or a folder of them (io/read/array_rows.h).
const FileFormat& NpyFormat();

/// Variables of a MATLAB file (io/read/array_rows.h).
const FileFormat& MatFormat();

/// The messages of one topic of a ROS 1 bag (io/read/bag_file.h),
/// sensor_msgs/Imu for an imu and sensor_msgs/NavSatFix for a position or
/// height, in the order in which they were received; their header's stamps, UTC
/// since 1970, become GPS time. Without a `topic` it is the only one of the
/// type. IMU readings stay in the axes of the message; east-north-up
/// covariances become north-east-down ones; fixes with status -1 are left out.
/// Standard deviations are absent from messages whose covariance type is
/// unknown. Throws InputError if the bag is damaged or holds no such topic.
const FileFormat& RosbagFormat();

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_FILE_FORMATS_H_
