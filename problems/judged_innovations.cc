#include "problems/judged_innovations.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <utility>

namespace hindsight {
Judgeable::Judgeable(const Timeline& timeline, const Dataset& dataset)
    : timeline_(timeline) {
  for (const AidingStream& stream : dataset.streams) {
    std::vector<double>& stamps = stamps_.emplace_back();
    stamps.reserve(stream.measurements.size());
    for (const Measurement& z : stream.measurements) stamps.push_back(z.t);
  }
}

bool Judgeable::Judges(const TapeMeasurement& z) const {
  return z.accepted && !z.withheld &&
         timeline_.sensors()[static_cast<std::size_t>(z.sensor)].loss.kind ==
             RobustLoss::Kind::kNone;
}

NormalisedInnovation Judgeable::Of(std::size_t k, const TapeMeasurement& z,
                                   RowVector rows, RowVector white) const {
  const auto sensor = static_cast<std::size_t>(z.sensor);
  const Measurement& measured =
      timeline_.measurements(k)[static_cast<std::size_t>(z.index)];
  std::size_t index = NormalisedInnovation::kOwn;
  if (sensor < stamps_.size()) {
    const std::vector<double>& stamps = stamps_[sensor];
    index = static_cast<std::size_t>(
        std::lower_bound(stamps.begin(), stamps.end(), measured.t) -
        stamps.begin());
  }
  std::vector<int> components;
  for (int row = 0; row < rows.size(); ++row) {
    components.push_back(ComponentOf(measured, row));
  }
  return {.t = timeline_.node(k).t,
          .sensor = z.sensor,
          .index = index,
          .rows = std::move(rows),
          .white = std::move(white),
          .components = std::move(components)};
}

std::vector<NormalisedInnovation> InnovationsOf(const LinearTape& tape,
                                                const Timeline& timeline,
                                                const Dataset& dataset) {
  const Judgeable judgeable(timeline, dataset);
  std::vector<NormalisedInnovation> all;
  all.reserve(timeline.all_measurements().size());
  for (std::size_t k = 0; k < tape.size(); ++k) {
    for (const TapeMeasurement& z : tape.measurements(k)) {
      if (!judgeable.Judges(z)) continue;
      all.push_back(judgeable.Of(
          k, z, z.innovation.cwiseQuotient(z.S.diagonal().cwiseSqrt()),
          Eigen::LLT<Eigen::MatrixXd>(z.S).matrixL().solve(z.innovation)));
    }
  }
  return all;
}

double LargestExcess(const std::vector<InnovationFigure>& figures) {
  double largest = 0.0;
  for (const InnovationFigure& one : figures) {
    largest = std::max(largest, one.excess);
  }
  return largest;
}

}  // namespace hindsight
