#include "app/method_output.h"

#include <algorithm>
#include <span>

#include "app/run_output.h"
#include "imu/imu_link.h"
#include "imu/mean_reading.h"
#include "io/write/atomic_file.h"
#include "io/write/column_csv.h"
#include "io/write/kml.h"
#include "io/write/motion_csv.h"
#include "io/write/nav.h"
#include "io/write/npz.h"
#include "io/write/solution_csv.h"
#include "io/write/tum.h"

namespace hindsight {

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
    files.push_back(std::make_unique<ColumnCsv>(folder_->Path(stem + ".csv"),
                                                comments, columns));
  }
  if (request_.exports.contains("npz")) {
    files.push_back(
        std::make_unique<Npz>(folder_->Path(stem + ".npz"), columns));
  }
  return files;
}

void MethodOutput::Append(const SolutionTable& piece) {
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
    const Eigen::MatrixXd rows =
        RowsOf(piece, columns_, k, std::min(k + kRowsOfPiece, piece.size()));
    for (const auto& file : files_) file->Append(rows);
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
  for (const auto& file : motion_files_) file->Append(rows);
  waiting_.erase(waiting_.begin(),
                 waiting_.begin() + static_cast<std::ptrdiff_t>(end - 1));
  motion_begun_ = true;
}

void MethodOutput::EndRows() {
  if (!columns_.empty()) WriteMotion(waiting_.size());
}

void MethodOutput::Commit() {
  if (columns_.empty()) return;
  for (const auto* files : {&files_, &motion_files_}) {
    for (const auto& file : *files) file->Commit();
  }
  WriteExports();
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
