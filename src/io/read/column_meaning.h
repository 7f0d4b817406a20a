#ifndef HINDSIGHT_IO_READ_COLUMN_MEANING_H_
#define HINDSIGHT_IO_READ_COLUMN_MEANING_H_

#include <string>
#include <vector>

#include "io/read/file_columns.h"

namespace hindsight {

/// What the title of a column says of it.
struct ColumnMeaning {
  /// As `columns` of a configuration names it: "t", "accel_x", "lat"; also
  /// "week" of GPS, "wheel_rate", "index" for what counts rows, "quaternion" of a part
  /// that nobody names, "sigma" of every axis, and "accuracy_h", "accuracy_v" and
  /// "accuracy_speed" as receivers state them; "" if the title says nothing.
  std::string quantity;
  std::string unit;      ///< as the title writes it; "" if it does not
  bool upwards = false;  ///< of a component that a title calls "up"
};

/// By the words of a title, which stand in any usual spelling: "Acc_X",
/// "gx_radps", "GYRO X [rad/s]", "gyroADC[0]", "V North [m/s]", "pos_std_n_m".
ColumnMeaning MeaningOfTitle(const std::string& title);

/// The velocity along the axis of a place: "north" says either.
ColumnMeaning AsVelocity(ColumnMeaning meaning);

/// Of a title that names an axis alone, "X (m/s^2)", the quantity family + "x";
/// nothing of another.
ColumnMeaning AxisMeaning(const std::string& title, const std::string& family);

/// Of a column by its title; of arrays of three or four columns without titles of
/// their own by their number, which counts axes. Nothing of text.
ColumnMeaning MeaningOfColumn(const FileColumn& column,
                              const FileFormat& format);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_COLUMN_MEANING_H_
