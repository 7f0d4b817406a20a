#include "filters/linear_tape.h"

#include <algorithm>
#include <bit>
#include <stdexcept>
#include <utility>

#include "linear/sparse_product.h"

namespace hindsight {
namespace {

constexpr std::size_t kBlockBytes = std::size_t{1} << 20;
constexpr std::size_t kBlock = kBlockBytes / sizeof(double);
constexpr std::size_t kLargestChunk = ScratchMemory::kSmallest / sizeof(double);

}  // namespace

double* LinearTape::Allocate(std::size_t count) {
  const auto place = [count](std::size_t used) {
    const bool fits = used % kBlock + count <= kBlock;
    return fits ? used : (used + kBlock - 1) / kBlock * kBlock;
  };
  if (chunks_.empty() ||
      place(chunks_.back().used) + count > chunks_.back().size) {
    // As large as all before together, so that few chunks hold a long tape and
    // a short one takes little.
    std::size_t size = 0;
    for (const Chunk& chunk : chunks_) size += chunk.size;
    size = std::clamp(size, kBlock, kLargestChunk);
    if (!chunks_.empty()) chunks_.back().memory.EndFilling();
    chunks_.push_back({ScratchMemory(size * sizeof(double), kBlockBytes,
                                     ScratchMemory::AtFirst::kAnything),
                       size, 0});
  }
  Chunk& chunk = chunks_.back();
  const std::size_t begin = place(chunk.used);
  chunk.used = begin + count;
  chunk.memory.BeforeWriting(begin / kBlock);
  return reinterpret_cast<double*>(chunk.memory.data()) + begin;
}

const LinearTape::PackedEpoch& LinearTape::Held(std::size_t k) const {
  const PackedEpoch& epoch = epochs_[k];
  const ScratchMemory& memory = chunks_[epoch.chunk].memory;
  const auto offset = static_cast<std::size_t>(
      epoch.data - reinterpret_cast<const double*>(memory.data()));
  memory.BeforeReading(offset / kBlock);
  return epoch;
}

std::size_t LinearTape::TriangleSize() const {
  const auto n = static_cast<std::size_t>(dim());
  return n * (n + 1) / 2;
}

std::size_t LinearTape::StateSize() const {
  constexpr std::size_t kNavigation = 17;
  return kNavigation + static_cast<std::size_t>(layout_.parameter_count());
}

double* LinearTape::Pack(const ErrorMatrix& P, double* to) const {
  for (int j = 0; j < dim(); ++j) {
    for (int i = j; i < dim(); ++i) *to++ = P(i, j);
  }
  return to;
}

double* LinearTape::Pack(const State& x, double* to) const {
  const auto put = [&to](const auto& values) {
    to = std::copy(values.data(), values.data() + values.size(), to);
  };
  *to++ = x.t;
  put(x.p_e);
  put(x.v_e);
  put(x.q_eb.coeffs());
  put(x.b_g);
  put(x.b_a);
  put(x.parameters);
  return to;
}

ErrorMatrix LinearTape::Unpack(const double* packed) const {
  ErrorMatrix P(dim(), dim());
  for (int j = 0; j < dim(); ++j) {
    for (int i = j; i < dim(); ++i) P(i, j) = P(j, i) = *packed++;
  }
  return P;
}

const double* LinearTape::Unpack(const double* packed, State* x) const {
  const auto take = [&packed](auto* values) {
    std::copy(packed, packed + values->size(), values->data());
    packed += values->size();
  };
  x->t = *packed++;
  take(&x->p_e);
  take(&x->v_e);
  take(&x->q_eb.coeffs());
  take(&x->b_g);
  take(&x->b_a);
  x->parameters.resize(layout_.parameter_count());
  take(&x->parameters);
  return packed;
}

const double* LinearTape::Unpack(const double* packed, bool present,
                                 ErrorVector* v) const {
  v->setZero(dim());
  if (!present) return packed;
  std::copy(packed, packed + dim(), v->data());
  return packed + dim();
}

namespace {

/// Rows with anything beside the diagonal, a bit each.
std::uint64_t FullRows(const ErrorMatrix& Phi) {
  std::uint64_t rows = 0;
  for (int j = 0; j < Phi.cols(); ++j) {
    for (int i = 0; i < Phi.rows(); ++i) {
      if (i != j && Phi(i, j) != 0.0) rows |= std::uint64_t{1} << i;
    }
  }
  return rows;
}

/// Calls use(i, j) for the elements of Phi that are recorded, in their order:
/// columns of the full rows, then the diagonal of the others.
template <typename Use>
void ForEachOfPhi(int dim, std::uint64_t full_rows, const Use& use) {
  for (int j = 0; j < dim; ++j) {
    for (std::uint64_t left = full_rows; left != 0; left &= left - 1) {
      use(std::countr_zero(left), j);
    }
  }
  for (int i = 0; i < dim; ++i) {
    if ((full_rows >> i & 1) == 0) use(i, i);
  }
}

bool IsSame(const State& a, const State& b) {
  return a.t == b.t && a.p_e == b.p_e && a.v_e == b.v_e &&
         a.q_eb.coeffs() == b.q_eb.coeffs() && a.b_g == b.b_g &&
         a.b_a == b.b_a && a.parameters == b.parameters;
}

}  // namespace

void LinearTape::Append(const TapeEpoch& epoch, const Transition& transition,
                        const ErrorMatrix& P_minus, const ErrorMatrix& P_plus) {
  const bool first = epochs_.empty();
  const auto n = static_cast<std::size_t>(dim());
  PackedEpoch& out = epochs_.emplace_back();
  out.t = epoch.t;
  out.reset = epoch.reset;
  moves_nominal_ = moves_nominal_ || epoch.moves_nominal();
  out.has_x_plus = !IsSame(epoch.x_minus, epoch.x_plus);
  out.has_c = !epoch.c.isZero(0.0);
  out.has_dx_minus = !epoch.dx_minus.isZero(0.0);
  out.has_dx_plus = !epoch.dx_plus.isZero(0.0);
  begins_.push_back(end_);
  out.first_measurement = measurements_end_;
  measurements_end_ = measurements_.size();
  if (!first) out.full_rows = FullRows(transition.Phi);
  const auto full = static_cast<std::size_t>(std::popcount(out.full_rows));
  const std::size_t vectors = static_cast<std::size_t>(out.has_c) +
                              static_cast<std::size_t>(out.has_dx_minus) +
                              static_cast<std::size_t>(out.has_dx_plus);
  double* to = Allocate((first ? 2 : 3) * TriangleSize() +
                        (out.has_x_plus ? 2 : 1) * StateSize() + vectors * n +
                        (first ? 0 : full * n + (n - full)));
  out.data = to;
  out.chunk = static_cast<std::uint32_t>(chunks_.size() - 1);
  to = Pack(P_plus, Pack(P_minus, to));
  if (!first) to = Pack(transition.Q, to);
  to = Pack(epoch.x_minus, to);
  if (out.has_x_plus) to = Pack(epoch.x_plus, to);
  const auto put = [&to](bool present, const ErrorVector& v) {
    if (present) to = std::copy(v.data(), v.data() + v.size(), to);
  };
  put(out.has_c, epoch.c);
  put(out.has_dx_minus, epoch.dx_minus);
  put(out.has_dx_plus, epoch.dx_plus);
  out.phi = static_cast<std::uint32_t>(to - out.data);
  if (!first) {
    ForEachOfPhi(dim(), out.full_rows,
                 [&](int i, int j) { *to++ = transition.Phi(i, j); });
  }
  end_ = {chunks_.size() - 1, chunks_.back().used};
}

TapeEpoch LinearTape::epoch(std::size_t k) const {
  const PackedEpoch& in = Held(k);
  TapeEpoch out;
  out.t = in.t;
  out.reset = in.reset;
  const double* from =
      Unpack(in.data + (k == 0 ? 2 : 3) * TriangleSize(), &out.x_minus);
  if (in.has_x_plus) {
    from = Unpack(from, &out.x_plus);
  } else {
    out.x_plus = out.x_minus;
  }
  from = Unpack(from, in.has_c, &out.c);
  from = Unpack(from, in.has_dx_minus, &out.dx_minus);
  Unpack(from, in.has_dx_plus, &out.dx_plus);
  return out;
}

void LinearTape::Record(const TapeMeasurement& header,
                        const LinearizedMeasurement& z,
                        const Innovation& innovation, const GainMatrix& K) {
  const Eigen::Index rows = z.residual.size();
  const Eigen::Index n = dim();
  const auto count =
      static_cast<std::size_t>(rows * (2 + n + 2 * rows) + K.size());
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
  new (&out.K) Matrix(take_matrix(K), K.rows(), K.cols());
}

ErrorMatrix LinearTape::Phi(std::size_t k) const {
  ErrorMatrix Phi = ErrorMatrix::Zero(dim(), dim());
  const PackedEpoch& in = Held(k);
  const double* from = in.data + in.phi;
  const int first = std::countr_one(in.full_rows);
  if (first == static_cast<int>(std::bit_width(in.full_rows))) {
    // As of nodes: the rows of the navigation state, which stand first.
    for (int j = 0; j < dim(); ++j) {
      Phi.col(j).head(first) = Eigen::Map<const Eigen::VectorXd>(from, first);
      from += first;
    }
    for (int i = first; i < dim(); ++i) Phi(i, i) = *from++;
    return Phi;
  }
  ForEachOfPhi(dim(), in.full_rows, [&](int i, int j) { Phi(i, j) = *from++; });
  return Phi;
}

SparseCongruence LinearTape::OverInterval(std::size_t k) const {
  const PackedEpoch& in = Held(k);
  const auto full = static_cast<Eigen::Index>(std::popcount(in.full_rows));
  const double* row = in.data + in.phi;
  const double* diagonal = row + full * dim();
  SparseCongruence out;
  for (int i = 0; i < dim(); ++i) {
    if ((in.full_rows >> i & 1) == 0) {
      out.AddRow(i, i, i + 1, [&](Eigen::Index) { return *diagonal; });
      ++diagonal;
    } else {
      out.AddRow(i, 0, dim(), [&](Eigen::Index j) { return row[j * full]; });
      ++row;
    }
  }
  return out;
}

ErrorVector LinearTape::c(std::size_t k) const {
  const PackedEpoch& in = Held(k);
  const std::size_t states = in.has_x_plus ? 2 : 1;
  ErrorVector c;
  Unpack(in.data + (k == 0 ? 2 : 3) * TriangleSize() + states * StateSize(),
         in.has_c, &c);
  return c;
}

ErrorMatrix LinearTape::Q(std::size_t k) const {
  return Unpack(PackedQ(k).data);
}

PackedSymmetric LinearTape::PackedQ(std::size_t k) const {
  return {Held(k).data + 2 * TriangleSize(), dim()};
}

ErrorMatrix LinearTape::P_minus(std::size_t k) const {
  return Unpack(Held(k).data);
}

ErrorMatrix LinearTape::P_plus(std::size_t k) const {
  return Unpack(Held(k).data + TriangleSize());
}

ErrorMatrix LinearTape::ResetTransport(const TapeEpoch& epoch) const {
  if (!epoch.moves_nominal()) return ErrorMatrix::Identity(dim(), dim());
  return Transport(error_, layout_, epoch.x_minus, epoch.dx_plus, epoch.x_plus);
}

State LinearTape::StateAt(const TapeEpoch& epoch, const ErrorVector& d) const {
  State x = Retract(error_, layout_, epoch.x_plus, d);
  x.t = epoch.t;
  return x;
}

void LinearTape::PopBack() {
  end_ = begins_.back();
  measurements_end_ = epochs_.back().first_measurement;
  measurements_.resize(measurements_end_);
  epochs_.pop_back();
  begins_.pop_back();
  chunks_.resize(end_.chunk + (epochs_.empty() ? 0 : 1));
  if (!chunks_.empty()) chunks_.back().used = end_.used;
}

std::size_t LinearTape::bytes() const {
  std::size_t bytes = epochs_.size() * (sizeof(PackedEpoch) + sizeof(Mark)) +
                      measurements_.size() * sizeof(TapeMeasurement);
  for (const Chunk& chunk : chunks_) bytes += chunk.used * sizeof(double);
  return bytes;
}

void RequireSmoothable(const LinearTape& tape) {
  if (!tape.smoothable()) {
    throw std::logic_error(
        "the tape's matrices P are not covariances of its system");
  }
}

}  // namespace hindsight
