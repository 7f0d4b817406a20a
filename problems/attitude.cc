#include "problems/attitude.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "alignment/given.h"
#include "alignment/magnetic_heading.h"
#include "base/error.h"
#include "base/processor_time.h"
#include "earth/wgs84.h"
#include "evaluation/grade.h"
#include "geometry/so3.h"
#include "measurements/sensor_kind.h"
#include "problems/attitude_evidence.h"

namespace hindsight {
namespace {

/// The samples of [from, to], increments as mean rates.
ImuStream RatesWithin(const ImuStream& imu, double from, double to) {
  ImuStream out = imu;
  out.kind = ImuStream::Kind::kRates;
  out.samples.clear();
  for (std::size_t k = 0; k < imu.samples.size(); ++k) {
    ImuSample sample = imu.samples[k];
    if (sample.t < from || sample.t > to) continue;
    if (imu.kind == ImuStream::Kind::kIncrements) {
      const std::size_t j = std::max<std::size_t>(k, 1);
      const double dt = imu.samples[j].t - imu.samples[j - 1].t;
      // The mean over the interval is the rate at its middle.
      sample.t -= 0.5 * dt;
      sample.gyro /= dt;
      sample.accel /= dt;
    }
    out.samples.push_back(sample);
  }
  if (out.empty()) throw InputError("no IMU data in the asked interval");
  return out;
}

}  // namespace

AttitudeEstimation::AttitudeEstimation(const Dataset& dataset,
                                       ReconstructionOptions options)
    : dataset_(dataset),
      options_(std::move(options)),
      imu_(RatesWithin(
          dataset.imu,
          GivenStartTime(dataset,
                         std::max(options_.from, dataset.imu.t_begin()),
                         std::min(options_.to, dataset.imu.t_end())),
          options_.to)),
      magnetic_(MagneticSamples(dataset)),
      headings_(HeadingSamples(dataset)),
      velocities_(VelocitySamples(dataset)),
      filter_options_(FilterOptionsOf(dataset)),
      q_en_(NedAxes(filter_options_.place.p_e)) {
  const auto outside = [this](const auto& sample) {
    return sample.t < imu_.t_begin() || sample.t > imu_.t_end();
  };
  std::erase_if(magnetic_, outside);
  std::erase_if(headings_, outside);
  std::erase_if(velocities_, outside);
  force_ratio_ = MedianForce(imu_) / filter_options_.place.gravity;
  if (IsOtherUnit(force_ratio_) && force_ratio_ > 0.0) {
    for (ImuSample& sample : imu_.samples) sample.accel /= force_ratio_;
  }
  std::optional<AlignedAttitude> found;
  if (magnetic_.empty()) {
    found = AttitudeByVelocity(dataset, imu_, options_.to);
  }
  const AlignedAttitude* start = found ? &*found : nullptr;
  if (!HeadingIsTold(dataset, start)) velocities_.clear();
  start_ = StartOfAttitude(dataset, imu_, magnetic_, start);
}

void AttitudeEstimation::Poll(const std::string& stage, double fraction) const {
  if (options_.stop != nullptr && *options_.stop) throw Interrupted();
  if (options_.progress) options_.progress(stage, fraction);
}

Solution AttitudeEstimation::Sample(const Solution& solution,
                                    const std::vector<double>& times) const {
  return SampleAttitude(solution, imu_, times);
}

Solution AttitudeEstimation::Run(const Method& method) {
  const double t0 = ProcessorSeconds();
  evidence_.clear();
  innovations_.clear();
  Solution solution = std::get<Method::OfAttitude>(method.run)(this);
  solution.method = method.name;
  solution.seconds = ProcessorSeconds() - t0;
  for (std::string& note : Unused()) solution.notes.push_back(std::move(note));
  const std::vector<Sensor> sources = JudgedSources();
  const std::vector<InnovationFigure> figures =
      TestInnovations(innovations_, kFalseAlarms);
  std::optional<StartValues> start;
  // With a field the smoother turns its start to the north that it surveys.
  if (magnetic_.empty()) {
    start =
        StartOf(solution.layout, start_.P,
                StateAt(start_.t, start_.q_nb, start_.b_g), dataset_.initial);
  }
  bool vouched_for = false;
  if (method.Has(MethodTrait::kForward)) {
    vouched_for = JudgeFilterByAll(start, sources, solution);
  } else {
    JudgeWhole(solution);
  }
  Conclude({.solution = solution,
            .sensors = sources,
            .start = start,
            .innovations = figures,
            .vouched_for = vouched_for,
            .recording = ExamineRecording(),
            .relative_heading =
                magnetic_.empty() && headings_.empty() && velocities_.empty(),
            .mounting_sigma = dataset_.mounting_sigma},
           {}, &solution);
  if (auto apart = methods_.Compare(solution)) {
    AddEvidence(*std::move(apart), &solution);
  }
  if (imu_.stamp_offset != 0.0) {
    std::vector<double> stamps;
    for (const ImuSample& sample : imu_.samples) {
      const double t = sample.t - imu_.stamp_offset;
      if (t >= imu_.t_begin()) stamps.push_back(t);
    }
    solution = SampleAttitude(solution, imu_, stamps);
  }
  return solution;
}

}  // namespace hindsight
