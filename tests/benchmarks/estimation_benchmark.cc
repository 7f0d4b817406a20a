#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <memory>

#include "benchmarks/smoothed_drive.h"
#include "problems/batch.h"
#include "problems/chain_problem.h"
#include "problems/reconstruction.h"

namespace hindsight {
namespace {

double PeakMegabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

const Dataset& Drive() {
  static const Dataset dataset = WalkingDrive("1 Hz");
  return dataset;
}

SmoothedDrive& Smoothed() {
  static SmoothedDrive smoothed(Drive());
  return smoothed;
}

/// From raw samples to three solutions with all covariances, alignment, nodes
/// and one preintegration included.
void FilterSmootherAndBatch(benchmark::State& state) {
  const Dataset& dataset = Drive();
  for (auto _ : state) {
    Reconstruction reconstruction(dataset, {});
    const Solution ekf = reconstruction.Run("ekf");
    const Solution rts = reconstruction.Run("rts");
    const Solution batch = reconstruction.Run("batch");
    benchmark::DoNotOptimize(batch.states.data());
    state.counters["ekf_s"] = ekf.seconds;
    state.counters["rts_s"] = rts.seconds;
    state.counters["batch_s"] = batch.seconds;
    state.counters["nodes"] = static_cast<double>(batch.states.size());
  }
  state.counters["peak_rss_mb"] = PeakMegabytes();
}
BENCHMARK(FilterSmootherAndBatch)->Unit(benchmark::kMillisecond);

void ForwardFilter(benchmark::State& state) {
  SmoothedDrive& drive = Smoothed();
  for (auto _ : state) {
    const LinearTape tape = RunExtendedKalmanFilter(&drive.problem);
    benchmark::DoNotOptimize(tape.back().x_plus.p_e.data());
  }
}
BENCHMARK(ForwardFilter)->Unit(benchmark::kMillisecond);

void RtsSmoother(benchmark::State& state) {
  SmoothedDrive& drive = Smoothed();
  const LinearTape tape = RunExtendedKalmanFilter(&drive.problem);
  for (auto _ : state) {
    const SmoothedTrajectory smoothed = SmoothRts(tape);
    benchmark::DoNotOptimize(smoothed.states.data());
  }
}
BENCHMARK(RtsSmoother)->Unit(benchmark::kMillisecond);

/// The batch from the smoother's trajectory, its marginal covariances included.
void BatchFromSmoother(benchmark::State& state) {
  SmoothedDrive& drive = Smoothed();
  for (auto _ : state) {
    const BatchResult result = SolveBatch(drive.states, {}, &drive.problem);
    state.counters["iterations"] = result.iterations;
  }
}
BENCHMARK(BatchFromSmoother)->Unit(benchmark::kMillisecond);

ChainProblem MakeChain(SmoothedDrive* drive) {
  return ChainProblem(drive->states, &drive->problem);
}

/// What of a step is residuals and Jacobians.
void BatchLinearisation(benchmark::State& state) {
  ChainProblem chain = MakeChain(&Smoothed());
  chain.KeepFactors();
  TangentFactor::Jacobian J;
  Eigen::VectorXd residual(kMaxErrorDim);
  for (auto _ : state) {
    for (const auto& factor : chain.factors()) {
      factor->Linearize(chain.ParametersOf(*factor).data(), residual.data(),
                        &J);
      benchmark::DoNotOptimize(J.data());
    }
  }
}
BENCHMARK(BatchLinearisation)->Unit(benchmark::kMillisecond);

/// Linearisation, factorisation and solution of one step.
void BatchStep(benchmark::State& state) {
  ChainProblem chain = MakeChain(&Smoothed());
  for (auto _ : state) {
    const ArrowLeastSquares step = chain.GaussNewtonStep();
    benchmark::DoNotOptimize(step.x(0).data());
  }
}
BENCHMARK(BatchStep)->Unit(benchmark::kMillisecond);

/// All marginals from a step at hand.
void AllMarginals(benchmark::State& state) {
  ChainProblem chain = MakeChain(&Smoothed());
  const ArrowLeastSquares step = chain.GaussNewtonStep();
  for (auto _ : state) {
    const CovarianceSeries marginals = chain.Marginals(step);
    benchmark::DoNotOptimize(marginals.size());
  }
}
BENCHMARK(AllMarginals)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hindsight
