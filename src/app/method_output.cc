#include "app/method_output.h"

#include <algorithm>
#include <span>

#include "app/run_output.h"
#include "imu/imu_link.h"
#include "imu/mean_reading.h"
#include "io/write/atomic_file.h"
#include "io/write/kml.h"
#include "io/write/motion_csv.h"
#include "io/write/nav.h"
#include "io/write/solution_csv.h"
#include "io/write/tum.h"

namespace hindsight {

void MethodOutput::Files::Append(const Eigen::MatrixXd& rows,
                                 const std::vector<bool>& some,
                                 ColumnCsv* some_csv) const {
  if (csv != nullptr && some_csv != nullptr) {
    csv->Append(rows, some, some_csv);
  } else if (csv != nullptr) {
    csv->Append(rows);
  }
  if (npz != nullptr) npz->Append(rows);
}

void MethodOutput::Files::Commit() const {
  if (csv != nullptr) csv->Commit();
  if (npz != nullptr) npz->Commit();
}

MethodOutput::MethodOutput(const RunRequest& request, const Dataset& dataset,
                           const Solution& solution, RowReadings* readings,
                           ResultFolder* folder)
    : request_(request),
      dataset_(dataset),
      solution_(solution),
      readings_(readings),
      folder_(folder) {}

MethodOutput::Files MethodOutput::Open(
    const std::string& stem, const std::string& comments,
    const std::vector<SolutionColumn>& columns) const {
  Files files;
  if (request_.exports.contains("csv")) {
    files.csv = std::make_unique<ColumnCsv>(folder_->Path(stem + ".csv"),
                                            comments, columns);
  }
  if (request_.exports.contains("npz")) {
    files.npz = std::make_unique<Npz>(folder_->Path(stem + ".npz"), columns);
  }
  return files;
}

void MethodOutput::OpenTruth(const SolutionTable& piece) {
  if (truth_csv_ != nullptr) return;
  truth_csv_ = std::make_unique<ColumnCsv>(
      folder_->Path(solution_.method + kTruthSuffix),
      SolutionComments(piece, ProgramLine(dataset_), dataset_.epoch_gps_ns),
      ColumnsOf(piece));
}

void MethodOutput::AppendTruth(const SolutionTable& piece) {
  if (piece.size() == 0) return;
  OpenTruth(piece);
  const std::vector<SolutionColumn> columns = ColumnsOf(piece);
  for (std::size_t k = 0; k < piece.size(); k += kRowsOfPiece) {
    truth_csv_->Append(
        RowsOf(piece, columns, k, std::min(k + kRowsOfPiece, piece.size())));
  }
}

void MethodOutput::Append(const SolutionTable& piece) { AppendRows(piece, {}); }

void MethodOutput::Append(const SolutionTable& piece,
                          const SolutionTable& truth) {
  if (truth.size() > 0 && request_.exports.contains("csv") &&
      std::ranges::includes(piece.t, truth.t)) {
    OpenTruth(truth);
    AppendRows(piece, truth.t);
  } else {
    AppendRows(piece, {});
    AppendTruth(truth);
  }
}

void MethodOutput::AppendRows(const SolutionTable& piece,
                              std::span<const double> others) {
  if (piece.size() == 0) return;
  if (columns_.empty()) {
    const std::string program = ProgramLine(dataset_);
    columns_ = ColumnsOf(piece);
    files_ =
        Open(solution_.method,
             SolutionComments(piece, program, dataset_.epoch_gps_ns), columns_);
    motion_files_ = Open(solution_.method + ".motion",
                         MotionComments(program, dataset_.epoch_gps_ns),
                         MotionFileColumns());
  }
  for (std::size_t k = 0; k < piece.size(); k += kRowsOfPiece) {
    const std::size_t end = std::min(k + kRowsOfPiece, piece.size());
    const Eigen::MatrixXd rows = RowsOf(piece, columns_, k, end);
    if (others.empty()) {
      files_.Append(rows);
      continue;
    }
    std::vector<bool> is_other;
    for (std::size_t i = k; i < end; ++i) {
      is_other.push_back(!others.empty() && others.front() == piece.t[i]);
      if (is_other.back()) others = others.subspan(1);
    }
    files_.Append(rows, is_other, truth_csv_.get());
  }
  waiting_.insert(waiting_.end(), piece.t.begin(), piece.t.end());
  WriteMotion(waiting_.size() - 1);
  if (request_.exports.contains("tum") || request_.exports.contains("kml") ||
      request_.exports.contains("nav")) {
    AppendTable(piece, &table_);
  }
}

void MethodOutput::WriteMotion(std::size_t end) {
  const std::size_t begin = motion_begun_ ? 1 : 0;
  if (begin >= end) return;
  const std::vector<State>& nodes = solution_.states;
  std::vector<Kinematics> motion = readings_->Of(waiting_);
  for (std::size_t i = 0; i < waiting_.size(); ++i) {
    while (node_ + 1 < nodes.size() && nodes[node_ + 1].t <= waiting_[i]) {
      ++node_;
    }
    motion[i] =
        WithoutErrors(motion[i], CalibrationOf(solution_.layout, nodes[node_]));
  }
  const std::size_t count = end - begin;
  const Eigen::MatrixXd rows =
      MotionRows(std::span(waiting_).subspan(begin, count),
                 std::span(motion).subspan(begin, count));
  motion_files_.Append(rows);
  waiting_.erase(waiting_.begin(),
                 waiting_.begin() + static_cast<std::ptrdiff_t>(end - 1));
  motion_begun_ = true;
}

void MethodOutput::EndRows() {
  if (!columns_.empty()) WriteMotion(waiting_.size());
}

void MethodOutput::Commit() {
  if (!columns_.empty()) {
    files_.Commit();
    motion_files_.Commit();
  }
  if (truth_csv_ != nullptr) truth_csv_->Commit();
  if (!columns_.empty()) WriteExports();
}

void MethodOutput::WriteExports() const {
  const std::string& method = solution_.method;
  const std::string remark = InjectionRemark(dataset_);
  if (request_.exports.contains("tum")) {
    WriteTum(folder_->Path(method + ".tum"), table_, remark);
  }
  if (request_.exports.contains("kml")) {
    WriteKml(folder_->Path(method + ".kml"), table_, dataset_.epoch_gps_ns,
             dataset_.name + " " + method, remark);
  }
  if (!request_.exports.contains("nav")) return;
  WriteNav(folder_->Path(method + ".nav"), table_, dataset_.epoch_gps_ns);
  // The format knows no comments.
  if (remark.empty()) return;
  WriteFileAtomically(folder_->Path(method + ".nav.txt"), remark + "\n");
}

}  // namespace hindsight
