#ifndef HINDSIGHT_IO_WRITE_NPZ_H_
#define HINDSIGHT_IO_WRITE_NPZ_H_

#include <cstdint>
#include <string>
#include <vector>

#include "io/write/atomic_file.h"
#include "io/write/column_file.h"
#include "io/write/unpublished.h"

struct archive;

namespace hindsight {

/// As NumPy's .npz: a ZIP archive, not compressed, beyond 4 GB with ZIP64, that
/// holds of each column an array of one dimension, little-endian doubles, as
/// NAME.npy, in the order of the columns.
///
/// An archive holds one array after the other, while rows have some of each: up
/// to Commit() they are in a file beside it that has no name, which takes as
/// much of the disk again.
class Npz : public ColumnFile {
 public:
  /// Throws OutputError.
  Npz(const std::string& path, const std::vector<SolutionColumn>& columns);

  void Append(const Eigen::MatrixXd& rows) override;
  void Commit() override;

 private:
  void WriteArray(std::size_t column, ::archive* archive);

  std::string path_;
  std::vector<std::string> names_;
  AtomicFile file_;
  Descriptor rows_;                        ///< the file without a name
  std::vector<std::int64_t> piece_sizes_;  ///< rows of each piece in it
  std::int64_t row_count_ = 0;
};

}  // namespace hindsight

#endif  // HINDSIGHT_IO_WRITE_NPZ_H_
