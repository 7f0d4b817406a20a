#ifndef HINDSIGHT_IO_READ_NMEA_H_
#define HINDSIGHT_IO_READ_NMEA_H_

#include <vector>

#include "io/read/row_buffer.h"
#include "io/read/text_lines.h"
#include "io/read/text_table.h"

namespace hindsight {

/// Reads NMEA 0183 sentences of any talker. Streams with a position or a
/// height take GGA: the height above the ellipsoid is the height above mean sea
/// level plus the geoid separation, the standard deviations are those of GST
/// when every fix has one, quality is GGA's, and so are the satellites where
/// every fix tells them. Streams of speed and course take
/// RMC: speed over the ground from knots, course absent where the receiver
/// gives none. Sentences without a fix are left out and counted, other
/// sentences are passed over. Time of day is UTC and continues over midnight;
/// the date is that of RMC or ZDA: with one, stamps are GPS time and `dated`
/// becomes true; else they are seconds of the first day. Throws InputError for
/// a wrong or missing checksum, a line that is no sentence and values out of
/// range.
RowBuffer ReadNmea(TextLines* lines, const std::vector<FieldName>& fields,
                   const TextTable::Options& options, bool* dated);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_NMEA_H_
