#ifndef HINDSIGHT_IO_WRITE_ALLAN_JSON_H_
#define HINDSIGHT_IO_WRITE_ALLAN_JSON_H_

#include <nlohmann/json.hpp>

#include "dataset/allan.h"

namespace hindsight {

/// `allan` of summary.json:
///   span_s                      [from, to] of the rest
///   tau_s[], log_sigma[]        AllanPoint, the same of all axes
///   axes[]                      axis ("gyro x"), unit (SI, of the readings),
///     deviation[]
///     white, instability, walk  {value, sigma}, AllanFit
nlohmann::ordered_json AllanJson(const ImuAllan& allan);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_WRITE_ALLAN_JSON_H_
