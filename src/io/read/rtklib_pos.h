#ifndef HINDSIGHT_IO_READ_RTKLIB_POS_H_
#define HINDSIGHT_IO_READ_RTKLIB_POS_H_

#include <string>
#include <string_view>
#include <vector>

#include "io/read/text_format.h"

namespace hindsight {

/// Layout of an RTKLIB solution file (.pos) from its column header, the last
/// line that starts with '%', and its first row. Time is GPST or UTC, as the
/// header says, as a date or as week and seconds of week. East-north-up values
/// become north-east-down: sigma_d = sdu, v_d = -vu, and the signed square
/// roots of covariances with "up" change sign. Throws InputError for headers
/// without latitude(deg), longitude(deg) and height(m).
TableLayout RtklibPosLayout(const std::string& path, long line,
                            std::string_view header, std::string_view first_row,
                            const std::vector<FieldName>& fields);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_RTKLIB_POS_H_
