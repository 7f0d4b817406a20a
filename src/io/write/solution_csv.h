#ifndef HINDSIGHT_IO_WRITE_SOLUTION_CSV_H_
#define HINDSIGHT_IO_WRITE_SOLUTION_CSV_H_

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/solution_table.h"
#include "io/read/solution_columns.h"

namespace hindsight {

/// The solution file: a block of '#' comment lines, one header line of
/// `name[unit]` columns, one line an epoch. Columns of quantities that the
/// solution does not have are left out.
///
///   t[s]
///   lat[deg] lon[deg] h[m]       WGS-84, height above the ellipsoid
///   v_n[m/s] v_e[m/s] v_d[m/s]   over the Earth, north-east-down
///   roll[deg] pitch[deg] heading[deg]
///                                C_nb = Rz(heading) Ry(pitch) Rx(roll), body
///                                forward-right-down; (-180, 180]
///   sd_n[m] sd_e[m] sd_d[m], sd_v_n[m/s] sd_v_e[m/s] sd_v_d[m/s]
///   sd_roll[deg] sd_pitch[deg] sd_heading[deg]
///                                of these angles, which are against the axes
///                                of a position that is uncertain itself
///                                (EulerSigma); at most 103.9 deg, which those
///                                of roll and heading reach at pitch +-90 deg
///   bg_x[deg/h] bg_y[deg/h] bg_z[deg/h], ba_x[m/s^2] ba_y[m/s^2] ba_z[m/s^2]
///                                biases, measured minus true, body axes
///   sd_bg_x[deg/h] ... sd_ba_z[m/s^2]
///   cov_p_ne[m^2] cov_p_nd[m^2] cov_p_ed[m^2]
///   cov_v_ne[m^2/s^2] cov_v_nd[m^2/s^2] cov_v_ed[m^2/s^2]
///   cov_psi_nn[rad^2] cov_psi_ne[rad^2] cov_psi_nd[rad^2] cov_psi_ee[rad^2]
///   cov_psi_ed[rad^2] cov_psi_dd[rad^2]
///                                psi in the axes of the estimated position,
///                                C_eb(true) = Exp(C_en psi) C_eb(estimated)
///   separation[1]                distance of forward and backward positions in
///                                sigmas, of two-filter smoothers; empty where
///                                the backward filter has no position
///   separation_n[m] separation_e[m] separation_d[m], separation_v_n[m/s]
///   separation_v_e[m/s] separation_v_d[m/s], separation_roll[deg]
///   separation_pitch[deg] separation_heading[deg]
///                                of two-filter smoothers, at the IMU: forward
///                                with the epoch's measurements minus backward
///                                without; empty where backward knows nothing
///   sd_separation_n[m] ...       sqrt(P_f + P_b) of each
///
/// Below are its parts, for files of other kinds and for rows that come piece by
/// piece: the columns, the same for all pieces of one solution; the rows from
/// `begin` to before `end`, in the columns' units, NaN where a field is empty;
/// the comment lines.
std::vector<SolutionColumn> ColumnsOf(const SolutionTable& table);
Eigen::MatrixXd RowsOf(const SolutionTable& table,
                       const std::vector<SolutionColumn>& columns,
                       std::size_t begin, std::size_t end);
std::string SolutionComments(const SolutionTable& table,
                             const std::string& program,
                             std::optional<std::int64_t> epoch_gps_ns);

/// Written to a temporary name and renamed. `program` ("hindsight 0.1.0") and
/// what t = 0 is (EpochComment; `epoch_gps_ns` as in Dataset) go into the
/// comments. Throws OutputError if the file cannot be written.
void WriteSolutionCsv(const std::string& path, const SolutionTable& table,
                      const std::string& program,
                      std::optional<std::int64_t> epoch_gps_ns);

/// Reads a file of the columns above, text, plain or gzip, or arrays (.npz,
/// io/write/npz.h) in their units, in any order, other columns skipped; units are converted except those of covariances. Only t is
/// required, but of a group (position, velocity, attitude, a bias, a set of
/// standard deviations or covariances) all columns or none must be there.
/// Standard deviations without cross terms make a diagonal covariance; without
/// cov_psi the attitude's is built from sd_roll, sd_pitch and sd_heading, as
/// if the position were exact.
/// Throws InputError "file:line: ..." (of arrays "file: row N: ...") for a file
/// that is missing, empty or cut off, a wrong unit, a wrong number of fields, a field that is no finite
/// number, a latitude beyond 90 deg, and a time that does not increase.
SolutionTable ReadSolutionTable(const std::string& path);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_WRITE_SOLUTION_CSV_H_
