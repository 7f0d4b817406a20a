#ifndef HINDSIGHT_BASE_PROCESSOR_TIME_H_
#define HINDSIGHT_BASE_PROCESSOR_TIME_H_

namespace hindsight {

/// Processor time of the calling thread since it began, and of others in its
/// ForRanges [s].
double ProcessorSeconds();
/// Counts what another thread took for the calling one [s].
void AddProcessorSeconds(double seconds);

}  // namespace hindsight

#endif  // HINDSIGHT_BASE_PROCESSOR_TIME_H_
