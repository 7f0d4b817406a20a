#ifndef HINDSIGHT_IO_READ_RESULT_COLUMNS_H_
#define HINDSIGHT_IO_READ_RESULT_COLUMNS_H_

#include <map>
#include <string>
#include <vector>

namespace hindsight {

/// The columns of a result file by their titles, "t[s]": comment lines, a line
/// of titles, a line a row; or a .npz, whose arrays have the titles of their
/// names (HeadingOf). A field that is empty or no number is NaN. All are of the
/// same length.
using NumberColumns = std::map<std::string, std::vector<double>>;

/// All columns but those whose titles begin with one of `without`. Throws
/// InputError for a file that cannot be read, has no titles, or a row with
/// fewer fields than these, and as ReadNpz.
NumberColumns ReadNumberColumns(const std::string& path,
                                const std::vector<std::string>& without = {});

/// One component of the measurements of one sensor, as residuals.csv has them
/// (io/write/residual_csv.h).
struct ResidualSeries {
  std::string sensor;
  int component = 0;
  std::vector<double> t;         ///< [s]
  std::vector<double> residual;  ///< SI
  std::vector<double> sigma;     ///< SI, NaN where there is none
  std::vector<double> weight;
  std::vector<char> status;  ///< 'u' used, 'r' rejected, 'w' withheld
};

/// Those of one method, in the order in which sensors first appear. Throws
/// InputError as above.
std::vector<ResidualSeries> ReadResiduals(const std::string& path,
                                          const std::string& method);

/// A fix as fixes.csv has it (io/write/fix_csv.h).
struct FixRow {
  double t = 0.0;  ///< [s]
  std::string sensor;
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
  double height = 0.0;      ///< [m]
  double sd_n = 0.0;        ///< [m]
  double sd_e = 0.0;        ///< [m]
  double sd_d = 0.0;        ///< [m]
  double quality = 0.0;     ///< as the receiver says, NaN if it does not
  double satellites = 0.0;  ///< in use, NaN if not known
  std::string status;
  double weight = 0.0;
};
std::vector<FixRow> ReadFixes(const std::string& path);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_RESULT_COLUMNS_H_
