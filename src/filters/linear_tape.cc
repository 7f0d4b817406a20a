#include "filters/linear_tape.h"

#include <stdexcept>
#include <utility>

namespace hindsight {
namespace {

constexpr std::size_t kChunkDoubles = std::size_t{1} << 17;

}  // namespace

double* LinearTape::Allocate(std::size_t count) {
  if (chunks_.empty() || chunks_.back().used + count > kChunkDoubles) {
    chunks_.push_back(
        {std::make_unique_for_overwrite<double[]>(kChunkDoubles), 0});
  }
  Chunk& chunk = chunks_.back();
  double* out = chunk.data.get() + chunk.used;
  chunk.used += count;
  return out;
}

double* LinearTape::Pack(const ErrorMatrix& P) {
  const auto n = static_cast<std::size_t>(dim());
  double* packed = Allocate(n * (n + 1) / 2);
  double* out = packed;
  for (int j = 0; j < dim(); ++j) {
    for (int i = j; i < dim(); ++i) *out++ = P(i, j);
  }
  return packed;
}

ErrorMatrix LinearTape::Unpack(const double* packed) const {
  ErrorMatrix P(dim(), dim());
  for (int j = 0; j < dim(); ++j) {
    for (int i = j; i < dim(); ++i) P(i, j) = P(j, i) = *packed++;
  }
  return P;
}

void LinearTape::Append(TapeEpoch epoch, const Transition& transition,
                        const ErrorMatrix& P_minus, const ErrorMatrix& P_plus) {
  Matrices m;
  m.chunk = mark_chunk_;
  m.used = mark_used_;
  if (!epochs_.empty()) {
    const auto n = static_cast<std::size_t>(dim());
    m.Phi = Allocate(n * n);
    Eigen::Map<Eigen::MatrixXd>(m.Phi, dim(), dim()) = transition.Phi;
    m.Q = Pack(transition.Q);
  }
  epoch.first_measurement =
      epochs_.empty()
          ? 0
          : epochs_.back().first_measurement + epochs_.back().measurement_count;
  epoch.measurement_count = measurements_.size() - epoch.first_measurement;
  m.P_minus = Pack(P_minus);
  m.P_plus = Pack(P_plus);
  epochs_.push_back(std::move(epoch));
  matrices_.push_back(m);
  mark_chunk_ = chunks_.size() - 1;
  mark_used_ = chunks_.back().used;
}

void LinearTape::Record(const TapeMeasurement& header,
                        const LinearizedMeasurement& z,
                        const Innovation& innovation) {
  const Eigen::Index rows = z.residual.size();
  const Eigen::Index n = dim();
  const auto count = static_cast<std::size_t>(rows * (2 + n + 2 * rows));
  double* data = Allocate(count);
  TapeMeasurement& out = measurements_.emplace_back(header);
  out.nis = innovation.nis;
  out.log_likelihood = innovation.log_likelihood;
  const auto take_vector = [&](const RowVector& v) {
    Eigen::Map<Eigen::VectorXd>(data, rows) = v;
    data += rows;
    return data - rows;
  };
  const auto take_matrix = [&](const auto& M) {
    Eigen::Map<Eigen::MatrixXd>(data, M.rows(), M.cols()) = M;
    data += M.size();
    return data - M.size();
  };
  using Vector = Eigen::Map<const Eigen::VectorXd>;
  using Matrix = Eigen::Map<const Eigen::MatrixXd>;
  new (&out.residual) Vector(take_vector(z.residual), rows);
  new (&out.innovation) Vector(take_vector(innovation.residual), rows);
  new (&out.H) Matrix(take_matrix(z.H), rows, n);
  new (&out.R) Matrix(take_matrix(z.R), rows, rows);
  new (&out.S) Matrix(take_matrix(innovation.S), rows, rows);
}

Eigen::Map<const Eigen::MatrixXd> LinearTape::Phi(std::size_t k) const {
  return {matrices_[k].Phi, dim(), dim()};
}

ErrorMatrix LinearTape::Q(std::size_t k) const {
  return Unpack(matrices_[k].Q);
}

ErrorMatrix LinearTape::P_minus(std::size_t k) const {
  return Unpack(matrices_[k].P_minus);
}

ErrorMatrix LinearTape::P_plus(std::size_t k) const {
  return Unpack(matrices_[k].P_plus);
}

ErrorMatrix LinearTape::ResetTransport(std::size_t k) const {
  const TapeEpoch& epoch = epochs_[k];
  if (!epoch.moves_nominal()) return ErrorMatrix::Identity(dim(), dim());
  return Transport(error_, layout_, epoch.x_minus, epoch.dx_plus, epoch.x_plus);
}

State LinearTape::StateAt(std::size_t k, const ErrorVector& d) const {
  State x = Retract(error_, layout_, epochs_[k].x_plus, d);
  x.t = epochs_[k].t;
  return x;
}

void LinearTape::PopBack() {
  mark_chunk_ = matrices_.back().chunk;
  mark_used_ = matrices_.back().used;
  measurements_.resize(epochs_.back().first_measurement);
  epochs_.pop_back();
  matrices_.pop_back();
  chunks_.resize(mark_chunk_ + (epochs_.empty() ? 0 : 1));
  if (!chunks_.empty()) chunks_.back().used = mark_used_;
}

void RequireSmoothable(const LinearTape& tape) {
  if (!tape.smoothable()) {
    throw std::logic_error(
        "the tape's matrices P are not covariances of its system");
  }
}

}  // namespace hindsight
