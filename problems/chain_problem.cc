#include "problems/chain_problem.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "factors/imu_factor.h"
#include "factors/measurement_factor.h"
#include "factors/prior_factor.h"
#include "linear/row_products.h"

namespace hindsight {

ChainProblem::ChainProblem(const std::vector<State>& states, Problem* problem)
    : blocks_(std::make_unique<StateBlocks>(problem->layout)) {
  Timeline* timeline = &problem->timeline;
  const GateDecisions& decisions = problem->decisions;
  nodes_.resize(states.size() *
                static_cast<std::size_t>(blocks_->node_ambient_dim()));
  for (std::size_t k = 0; k < states.size(); ++k) {
    times_.push_back(timeline->node(k).t);
    blocks_->WriteNode(states[k], node_values(k));
  }
  for (const StateBlocks::Entry& entry : blocks_->globals()) {
    globals_.emplace_back(
        static_cast<std::size_t>(FullDimension(entry.block.key.kind)));
    blocks_->WriteGlobal(states.front(), entry.ambient, globals_.back().data());
  }
  factors_.push_back(std::make_unique<PriorFactor>(
      blocks_.get(), problem->prior.x, problem->prior.P));
  std::size_t index = 0;
  for (std::size_t k = 0; k < states.size(); ++k) {
    const int node = static_cast<int>(k);
    if (k + 1 < states.size()) {
      const ImuSummary& summary =
          timeline->Integrate(k, CalibrationOf(problem->layout, states[k]));
      factors_.push_back(std::make_unique<ImuFactor>(
          blocks_.get(), timeline, node, Travelled(states[k], summary.dt())));
    }
    for (const Measurement& z : timeline->measurements(k)) {
      const bool used = decisions.empty() ? !z.withheld : decisions[index] != 0;
      ++index;
      if (!used) continue;
      factors_.push_back(std::make_unique<MeasurementFactor>(
          blocks_.get(), timeline, node, &z));
      const RobustLoss& loss =
          timeline->sensors()[static_cast<std::size_t>(z.sensor)].loss;
      losses_.resize(factors_.size());
      if (loss.kind != RobustLoss::Kind::kNone) {
        losses_.back() =
            std::make_unique<RobustLossFunction>(loss.OfRows(Rows(z)));
      }
    }
  }
  losses_.resize(factors_.size());
}

bool ChainProblem::HasLoss() const {
  return std::any_of(losses_.begin(), losses_.end(),
                     [](const auto& loss) { return loss != nullptr; });
}

double ChainProblem::LargestRobustRatio() {
  double largest = 0.0;
  Eigen::VectorXd residual(kMaxErrorDim);
  for (std::size_t i = 0; i < factors_.size(); ++i) {
    if (losses_[i] == nullptr || !losses_[i]->loss().redescends()) continue;
    const std::vector<double*> parameters = ParametersOf(*factors_[i]);
    factors_[i]->Linearize(parameters.data(), residual.data(), nullptr);
    largest =
        std::max(largest, residual.head(factors_[i]->num_residuals()).norm() /
                              losses_[i]->loss().scale);
  }
  return largest;
}

void ChainProblem::SetWidening(double widening) {
  for (const auto& loss : losses_) {
    if (loss != nullptr && loss->loss().redescends()) {
      loss->set_widening(widening);
    }
  }
}

std::vector<double*> ChainProblem::ParametersOf(const TangentFactor& factor) {
  std::vector<double*> parameters;
  for (const int k : factor.nodes()) {
    parameters.push_back(node_values(static_cast<std::size_t>(k)));
  }
  for (const int g : factor.globals()) {
    parameters.push_back(global_values(static_cast<std::size_t>(g)));
  }
  return parameters;
}

std::vector<State> ChainProblem::States() const {
  std::vector<const double*> globals;
  for (const auto& values : globals_) globals.push_back(values.data());
  std::vector<State> states;
  states.reserve(times_.size());
  const auto stride = static_cast<std::size_t>(blocks_->node_ambient_dim());
  for (std::size_t k = 0; k < times_.size(); ++k) {
    states.push_back(
        blocks_->ReadState(times_[k], nodes_.data() + k * stride, globals));
  }
  return states;
}

namespace {

/// Subtracts J'r of one factor from the right side.
void AddGradient(const StateBlocks& blocks, const TangentFactor& factor,
                 const TangentFactor::Jacobian& J, const Eigen::VectorXd& r,
                 ArrowSystem* arrow) {
  const auto rows = r.head(factor.num_residuals());
  Eigen::Index column = 0;
  for (const int k : factor.nodes()) {
    const auto J_k = J.middleCols(column, blocks.node_dim());
    arrow->rhs(k).noalias() -= J_k.transpose() * rows;
    column += blocks.node_dim();
  }
  for (const int g : factor.globals()) {
    const StateBlocks::Entry& entry =
        blocks.globals()[static_cast<std::size_t>(g)];
    arrow->rhs_border().segment(entry.tangent, entry.block.dim).noalias() -=
        J.middleCols(column, entry.block.dim).transpose() * rows;
    column += entry.block.dim;
  }
}

/// Adds J'J of one factor to the blocks of the arrow it touches, of symmetric
/// ones to the lower triangle.
void AddInformation(const StateBlocks& blocks, const TangentFactor& factor,
                    const TangentFactor::Jacobian& J, ArrowSystem* arrow) {
  const int n = blocks.node_dim();
  const auto columns = [&](Eigen::Index first, int count) {
    return RowSpan{J.data() + first, J.cols(), factor.num_residuals(), count};
  };
  const auto& nodes = factor.nodes();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    ArrowSystem::Block node = arrow->node(nodes[i]);
    AddSquare(columns(static_cast<Eigen::Index>(i) * n, n), node.data(),
              node.outerStride());
  }
  if (nodes.size() == 2) {
    ArrowSystem::Block coupling = arrow->coupling(nodes[0]);
    AddTransposedProduct(columns(n, n), columns(0, n), coupling.data(),
                         coupling.outerStride());
  }
  const Eigen::Index node_columns = n * static_cast<Eigen::Index>(nodes.size());
  Eigen::Index column = node_columns;
  for (const int g : factor.globals()) {
    const StateBlocks::Entry& entry =
        blocks.globals()[static_cast<std::size_t>(g)];
    const RowSpan J_g = columns(column, entry.block.dim);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      ArrowSystem::Block coupling = arrow->border_coupling(nodes[i]);
      AddTransposedProduct(J_g, columns(static_cast<Eigen::Index>(i) * n, n),
                           coupling.data() + entry.tangent,
                           coupling.outerStride());
    }
    ArrowSystem::Block border = arrow->border();
    Eigen::Index other_column = node_columns;
    for (const int h : factor.globals()) {
      const StateBlocks::Entry& other =
          blocks.globals()[static_cast<std::size_t>(h)];
      AddTransposedProduct(J_g, columns(other_column, other.block.dim),
                           &border(entry.tangent, other.tangent),
                           border.outerStride());
      other_column += other.block.dim;
    }
    column += entry.block.dim;
  }
}

}  // namespace

ArrowSystem ChainProblem::Information() {
  ArrowSystem arrow(static_cast<int>(times_.size()), blocks_->node_dim(),
                    blocks_->global_dim());
  TangentFactor::Jacobian J;
  Eigen::VectorXd residual(kMaxErrorDim);
  for (std::size_t i = 0; i < factors_.size(); ++i) {
    const TangentFactor& factor = *factors_[i];
    const std::vector<double*> parameters = ParametersOf(factor);
    factor.Linearize(parameters.data(), residual.data(), &J);
    if (losses_[i] != nullptr) {
      const double s = residual.head(factor.num_residuals()).squaredNorm();
      const double root_weight = std::sqrt(losses_[i]->loss().Weight(s));
      J *= root_weight;
      residual *= root_weight;
    }
    AddInformation(*blocks_, factor, J, &arrow);
    AddGradient(*blocks_, factor, J, residual, &arrow);
  }
  return arrow;
}

double ChainProblem::StepSize(const ArrowSystem& solved) const {
  double sum = 0.0;
  for (std::size_t k = 0; k < times_.size(); ++k) {
    sum += solved.rhs(static_cast<int>(k)).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(times_.size()));
}

void ChainProblem::Apply(const ArrowSystem& solved) {
  const NodeManifold manifold(blocks_.get());
  for (std::size_t k = 0; k < times_.size(); ++k) {
    const auto step = solved.rhs(static_cast<int>(k));
    manifold.Plus(node_values(k), step.data(), node_values(k));
  }
  for (const StateBlocks::Entry& entry : blocks_->globals()) {
    const auto step =
        solved.rhs_border().segment(entry.tangent, entry.block.dim);
    auto& values = globals_[static_cast<std::size_t>(entry.ambient)];
    for (int i = 0; i < entry.block.dim; ++i) {
      values[static_cast<std::size_t>(i)] += step(i);
    }
  }
}

CovarianceSeries ChainProblem::Marginals(const ArrowSystem& factored) const {
  const int n = blocks_->layout().dim();
  CovarianceSeries series(n, times_.size());
  const Eigen::MatrixXd border = factored.BorderCovariance();
  factored.VisitMarginals([&](const ArrowSystem::NodeMarginal& marginal) {
    ErrorMatrix P(n, n);
    for (const StateBlocks::Entry& a : blocks_->entries()) {
      for (const StateBlocks::Entry& b : blocks_->entries()) {
        auto out =
            P.block(a.block.offset, b.block.offset, a.block.dim, b.block.dim);
        if (!a.global && !b.global) {
          out = marginal.covariance.block(a.tangent, b.tangent, a.block.dim,
                                          b.block.dim);
        } else if (a.global && b.global) {
          out = border.block(a.tangent, b.tangent, a.block.dim, b.block.dim);
        } else if (a.global) {
          out = marginal.border_node.block(a.tangent, b.tangent, a.block.dim,
                                           b.block.dim);
        } else {
          out = marginal.border_node
                    .block(b.tangent, a.tangent, b.block.dim, a.block.dim)
                    .transpose();
        }
      }
    }
    series.Set(static_cast<std::size_t>(marginal.node), P);
  });
  return series;
}

}  // namespace hindsight
