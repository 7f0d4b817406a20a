#ifndef HINDSIGHT_APP_METHOD_OUTPUT_H_
#define HINDSIGHT_APP_METHOD_OUTPUT_H_

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "app/result_folder.h"
#include "app/row_readings.h"
#include "app/run_request.h"
#include "evaluation/solution_table.h"
#include "io/write/column_csv.h"
#include "io/write/npz.h"
#include "state/solution.h"

namespace hindsight {

/// Of the file beside METHOD.csv that `evaluate` compares with the truth.
inline constexpr const char* kTruthSuffix = ".truth.csv";

/// The rows of one method's output, written as they come: METHOD.csv and
/// METHOD.motion.csv, or the same as .npz, and METHOD.truth.csv, at the truth's times
/// and the point it speaks of, of which none is held in memory, and
/// the other formats of --export, for which the table is.
class MethodOutput {
 public:
  /// References stay valid up to the end. Throws OutputError, as all here.
  MethodOutput(const RunRequest& request, const Dataset& dataset,
               const Solution& solution, RowReadings* readings,
               ResultFolder* folder);

  /// Adds rows of the solution, later than all before.
  void Append(const SolutionTable& piece);
  /// The same of METHOD.truth.csv.
  void AppendTruth(const SolutionTable& piece);
  /// Adds rows of both, which are of one point: what they have in common is written
  /// out once.
  void Append(const SolutionTable& piece, const SolutionTable& truth);
  /// To be called behind the last row; the last to need `readings`.
  void EndRows();
  /// Finishes the files.
  void Commit();

 private:
  /// `stem`.csv, `stem`.npz or both, as asked for.
  struct Files {
    std::unique_ptr<ColumnCsv> csv;
    std::unique_ptr<Npz> npz;

    /// `some` as in ColumnCsv::Append, if there is a `some_csv`.
    void Append(const Eigen::MatrixXd& rows, const std::vector<bool>& some = {},
                ColumnCsv* some_csv = nullptr) const;
    void Commit() const;
  };
  Files Open(const std::string& stem, const std::string& comments,
             const std::vector<SolutionColumn>& columns) const;
  void OpenTruth(const SolutionTable& piece);
  /// Adds rows; those at `others`, times of such rows, to METHOD.truth.csv as well.
  void AppendRows(const SolutionTable& piece, std::span<const double> others);
  /// Of the waiting rows before `end`.
  void WriteMotion(std::size_t end);
  void WriteExports() const;

  const RunRequest& request_;
  const Dataset& dataset_;
  const Solution& solution_;
  RowReadings* readings_;
  ResultFolder* folder_;
  std::vector<SolutionColumn> columns_;  ///< from the first row on, as files
  Files files_;
  Files motion_files_;
  std::unique_ptr<ColumnCsv> truth_csv_;  ///< from the first row on
  /// Times of rows whose motion waits, as it needs the time after; behind that
  /// of the last row written, if there is one.
  std::vector<double> waiting_;
  bool motion_begun_ = false;
  std::size_t node_ = 0;  ///< the last of the solution before these
  SolutionTable table_;   ///< all rows, if an export needs them
};

}  // namespace hindsight

#endif  // HINDSIGHT_APP_METHOD_OUTPUT_H_
