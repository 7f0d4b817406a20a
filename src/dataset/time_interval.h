#ifndef HINDSIGHT_DATASET_TIME_INTERVAL_H_
#define HINDSIGHT_DATASET_TIME_INTERVAL_H_

namespace hindsight {

struct TimeInterval {
  double begin = 0.0;  ///< [s]
  double end = 0.0;    ///< [s]

  double length() const { return end - begin; }
};

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_TIME_INTERVAL_H_
