#include "evaluation/solution_table.h"

#include <cstddef>

#include "state/euler_error.h"

namespace hindsight {
namespace {

/// First component of a block that is estimated in all three axes, or -1.
int CompleteOffset(const ErrorLayout& layout, BlockKind kind) {
  const Block* block = layout.Find(kind);
  return block != nullptr && block->dim == 3 ? block->offset : -1;
}

void FillCovariances(const Solution& solution, std::size_t begin,
                     std::size_t end, SolutionTable* table) {
  const ErrorLayout& layout = solution.layout;
  const int position = CompleteOffset(layout, BlockKind::kPosition);
  const int velocity = CompleteOffset(layout, BlockKind::kVelocity);
  const int attitude = CompleteOffset(layout, BlockKind::kAttitude);
  const int gyro_bias = CompleteOffset(layout, BlockKind::kGyroBias);
  const int accel_bias = CompleteOffset(layout, BlockKind::kAccelBias);
  for (std::size_t k = begin; k < end; ++k) {
    const ErrorMatrix P = solution.covariances.Get(k);
    const auto append = [&P](int offset, std::vector<Eigen::Matrix3d>* out) {
      if (offset >= 0) out->push_back(P.block<3, 3>(offset, offset));
    };
    append(position, &table->P_position);
    append(velocity, &table->P_velocity);
    append(attitude, &table->P_attitude);
    if (attitude >= 0) {
      table->sigma_euler.push_back(EulerSigma(layout, solution.states[k], P));
    }
    const auto append_sigma = [&P](int offset,
                                   std::vector<Eigen::Vector3d>* out) {
      if (offset < 0) return;
      out->push_back(P.diagonal().segment<3>(offset).cwiseMax(0.0).cwiseSqrt());
    };
    append_sigma(gyro_bias, &table->sigma_b_g);
    append_sigma(accel_bias, &table->sigma_b_a);
  }
}

}  // namespace

Eigen::Matrix3d SolutionTable::C_en(std::size_t k) const {
  if (p_e.empty()) return Eigen::Matrix3d::Identity();
  return NedAxes(p_e[k]);
}

Eigen::Quaterniond SolutionTable::q_nb(std::size_t k) const {
  return Eigen::Quaterniond(C_en(k)).conjugate() * q_eb[k];
}

SolutionTable TableFromSolution(const Solution& solution) {
  return TableFromSolution(solution, 0, solution.states.size());
}

SolutionTable TableFromSolution(const Solution& solution, std::size_t begin,
                                std::size_t end) {
  SolutionTable table;
  table.method = solution.method;
  const auto take = [begin, end](const auto& from, auto* to) {
    if (from.empty()) return;
    to->assign(from.begin() + static_cast<std::ptrdiff_t>(begin),
               from.begin() + static_cast<std::ptrdiff_t>(end));
  };
  if (solution.two_filter) {
    take(solution.two_filter->separation, &table.separation);
    take(solution.two_filter->components, &table.separations);
  }
  if (solution.attitude) {
    take(solution.attitude->accel_sigma, &table.accel_sigma);
    take(solution.attitude->magnetic, &table.magnetic);
  }
  const ErrorLayout& layout = solution.layout;
  const bool has_position = layout.Has(BlockKind::kPosition);
  for (std::size_t k = begin; k < end; ++k) {
    const State& x = solution.states[k];
    table.t.push_back(x.t);
    // Without a place the state's own axes at p_e would be arbitrary; its
    // velocity and attitude are brought to local axes once, here.
    const Eigen::Matrix3d C = has_position
                                  ? Eigen::Matrix3d::Identity().eval()
                                  : Eigen::Matrix3d(x.C_en().transpose());
    if (has_position) table.p_e.push_back(x.p_e);
    if (layout.Has(BlockKind::kVelocity)) table.v_e.emplace_back(C * x.v_e);
    if (layout.Has(BlockKind::kAttitude)) {
      table.q_eb.push_back(Eigen::Quaterniond(C) * x.q_eb);
    }
    if (layout.Has(BlockKind::kGyroBias)) table.b_g.push_back(x.b_g);
    if (layout.Has(BlockKind::kAccelBias)) table.b_a.push_back(x.b_a);
  }
  if (!solution.covariances.empty()) {
    FillCovariances(solution, begin, end, &table);
  }
  return table;
}

namespace {

/// Calls `visit` with each column of two tables.
template <typename From, typename To, typename Visitor>
void VisitColumns(From& from, To& to, const Visitor& visit) {
  visit(from.t, to.t);
  visit(from.p_e, to.p_e);
  visit(from.v_e, to.v_e);
  visit(from.q_eb, to.q_eb);
  visit(from.P_position, to.P_position);
  visit(from.P_velocity, to.P_velocity);
  visit(from.P_attitude, to.P_attitude);
  visit(from.sigma_euler, to.sigma_euler);
  visit(from.b_g, to.b_g);
  visit(from.b_a, to.b_a);
  visit(from.sigma_b_g, to.sigma_b_g);
  visit(from.sigma_b_a, to.sigma_b_a);
  visit(from.separation, to.separation);
  visit(from.separations, to.separations);
  visit(from.accel_sigma, to.accel_sigma);
  visit(from.magnetic, to.magnetic);
}

}  // namespace

SolutionTable RowsOf(const SolutionTable& table,
                     const std::vector<std::size_t>& rows) {
  SolutionTable some;
  some.method = table.method;
  VisitColumns(table, some, [&rows](const auto& from, auto& to) {
    if (from.empty()) return;
    for (const std::size_t row : rows) to.push_back(from[row]);
  });
  return some;
}

void AppendTable(const SolutionTable& piece, SolutionTable* table) {
  table->method = piece.method;
  VisitColumns(piece, *table, [](const auto& from, auto& to) {
    to.insert(to.end(), from.begin(), from.end());
  });
}

TruthSeries TruthFromTable(const SolutionTable& table) {
  TruthSeries truth;
  for (std::size_t k = 0; k < table.size(); ++k) {
    TruthPoint point;
    point.t = table.t[k];
    if (!table.p_e.empty()) point.p_e = table.p_e[k];
    if (!table.v_e.empty()) {
      point.v_n = table.C_en(k).transpose() * table.v_e[k];
    }
    if (!table.q_eb.empty()) point.q_nb = table.q_nb(k);
    if (!table.b_g.empty()) point.b_g = table.b_g[k];
    if (!table.b_a.empty()) point.b_a = table.b_a[k];
    truth.push_back(point);
  }
  return truth;
}

}  // namespace hindsight
