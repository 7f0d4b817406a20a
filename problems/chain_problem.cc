#include "problems/chain_problem.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"
#include "factors/imu_factor.h"
#include "factors/measurement_factor.h"
#include "factors/prior_factor.h"

namespace hindsight {
namespace {

/// Factors that are worth a thread.
constexpr std::size_t kFactorsOfThread = 32;

}  // namespace

ChainProblem::ChainProblem(const std::vector<State>& states, Problem* problem)
    : blocks_(std::make_unique<StateBlocks>(problem->layout)) {
  Timeline* timeline = &problem->timeline;
  const GateDecisions& decisions = problem->decisions;
  nodes_.resize(states.size() *
                static_cast<std::size_t>(blocks_->node_ambient_dim()));
  for (std::size_t k = 0; k < states.size(); ++k) {
    times_.push_back(timeline->node(k).t);
  }
  for (const StateBlocks::Entry& entry : blocks_->globals()) {
    globals_.emplace_back(
        static_cast<std::size_t>(FullDimension(entry.block.key.kind)));
  }
  Set(states);
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

void ChainProblem::Set(const std::vector<State>& states) {
  for (std::size_t k = 0; k < states.size(); ++k) {
    if (states[k].parameters.size() != blocks_->layout().parameter_count()) {
      throw std::logic_error("a state of another layout than its problem");
    }
    blocks_->WriteNode(states[k], node_values(k));
  }
  for (const StateBlocks::Entry& entry : blocks_->globals()) {
    blocks_->WriteGlobal(
        states.front(), entry.ambient,
        globals_[static_cast<std::size_t>(entry.ambient)].data());
  }
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

/// Rows of a factor that sees one node, or a node and the next.
void AddRows(const StateBlocks& blocks, const TangentFactor& factor,
             const TangentFactor::Jacobian& J, const Eigen::VectorXd& residual,
             ArrowLeastSquares* arrow) {
  const int n = blocks.node_dim();
  const int count = factor.num_residuals();
  const bool is_link = factor.nodes().size() == 2;
  const int k = factor.nodes().front();
  ArrowLeastSquares::Rows rows =
      is_link ? arrow->AddToLink(k, count) : arrow->AddToNode(k, count);
  rows.residual() = residual.head(count);
  rows.node() = J.leftCols(n);
  if (is_link) rows.next() = J.middleCols(n, n);
  Eigen::Index column = is_link ? 2 * n : n;
  for (const int g : factor.globals()) {
    const StateBlocks::Entry& entry =
        blocks.globals()[static_cast<std::size_t>(g)];
    rows.border().middleCols(entry.tangent, entry.block.dim) =
        J.middleCols(column, entry.block.dim);
    column += entry.block.dim;
  }
}

/// "dvl_bias[x]".
std::string NameOf(const StateBlocks& blocks, const Deficiency& deficiency) {
  const bool global = deficiency.node == Deficiency::kBorder;
  for (const StateBlocks::Entry& entry : blocks.entries()) {
    const int i = deficiency.component - entry.tangent;
    if (entry.global == global && i >= 0 && i < entry.block.dim) {
      return blocks.layout().ComponentName(entry.block.offset + i);
    }
  }
  return "an unknown";
}

}  // namespace

double ChainProblem::Linearize(std::size_t i, TangentFactor::Jacobian* J,
                               Eigen::VectorXd* residual) {
  const TangentFactor& factor = *factors_[i];
  residual->resize(factor.num_residuals());
  factor.Linearize(ParametersOf(factor).data(), residual->data(), J);
  const double square = residual->squaredNorm();
  if (losses_[i] == nullptr) return square;
  const RobustLoss loss = losses_[i]->loss();
  const double root_weight = std::sqrt(loss.Weight(square));
  *J *= root_weight;
  *residual *= root_weight;
  return loss.Cost(square);
}

void ChainProblem::KeepFactors() {
  if (std::exchange(is_kept_, true)) return;
  ForRanges(factors_.size(), kFactorsOfThread,
            [&](std::size_t begin, std::size_t end) {
              for (std::size_t i = begin; i < end; ++i) factors_[i]->Keep();
            });
}

ArrowLeastSquares ChainProblem::GaussNewtonStep() {
  if (steps_++ > 0) KeepFactors();
  ArrowLeastSquares arrow(static_cast<int>(times_.size()), blocks_->node_dim(),
                          blocks_->global_dim());
  // As many as a cache holds of their Jacobians.
  constexpr std::size_t kFactorsAtOnce = 256;
  std::vector<TangentFactor::Jacobian> J(kFactorsAtOnce);
  std::vector<Eigen::VectorXd> residuals(kFactorsAtOnce);
  std::vector<double> losses(kFactorsAtOnce);
  double sum = 0.0;
  for (std::size_t first = 0; first < factors_.size();
       first += kFactorsAtOnce) {
    const std::size_t count = std::min(kFactorsAtOnce, factors_.size() - first);
    ForRanges(count, kFactorsOfThread, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        losses[i] = Linearize(first + i, &J[i], &residuals[i]);
      }
    });
    for (std::size_t i = 0; i < count; ++i) {
      sum += losses[i];
      AddRows(*blocks_, *factors_[first + i], J[i], residuals[i], &arrow);
    }
  }
  linearized_cost_ = 0.5 * sum;
  const std::vector<Deficiency> deficient = arrow.Solve();
  if (!deficient.empty()) {
    throw EstimationError("batch: the data leave " +
                          NameOf(*blocks_, deficient.front()) +
                          " undetermined");
  }
  return arrow;
}

double ChainProblem::StepSize(const ArrowLeastSquares& step) const {
  double sum = 0.0;
  for (std::size_t k = 0; k < times_.size(); ++k) {
    sum += step.x(static_cast<int>(k)).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(times_.size()));
}

void ChainProblem::Apply(const ArrowLeastSquares& step, double part) {
  const NodeManifold manifold(blocks_.get());
  Eigen::VectorXd move;
  for (std::size_t k = 0; k < times_.size(); ++k) {
    move = part * step.x(static_cast<int>(k));
    manifold.Plus(node_values(k), move.data(), node_values(k));
  }
  for (const StateBlocks::Entry& entry : blocks_->globals()) {
    move = part * step.x_border().segment(entry.tangent, entry.block.dim);
    auto& values = globals_[static_cast<std::size_t>(entry.ambient)];
    for (int i = 0; i < entry.block.dim; ++i) {
      values[static_cast<std::size_t>(i)] += move(i);
    }
  }
}

CovarianceSeries ChainProblem::Marginals(const ArrowLeastSquares& step) const {
  const int n = blocks_->layout().dim();
  CovarianceSeries series(n, times_.size());
  const Eigen::MatrixXd border = step.BorderCovariance();
  step.VisitMarginals([&](const ArrowLeastSquares::NodeMarginal& marginal) {
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
