#ifndef HINDSIGHT_BASE_PROCESSOR_TIME_H_
#define HINDSIGHT_BASE_PROCESSOR_TIME_H_

namespace hindsight {

/// Processor time of the calling thread since it began [s].
double ProcessorSeconds();

}  // namespace hindsight

#endif  // HINDSIGHT_BASE_PROCESSOR_TIME_H_
