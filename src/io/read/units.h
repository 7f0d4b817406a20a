#ifndef HINDSIGHT_IO_READ_UNITS_H_
#define HINDSIGHT_IO_READ_UNITS_H_

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/quantity.h"
#include "base/text.h"

namespace hindsight {

/// SI unit as it is written, e.g. "rad/sqrt(s)".
const char* SiUnit(Quantity quantity);

/// Units that may stand for `quantity`, as a list for messages; not every
/// accepted spelling is in it.
const char* UnitExamples(Quantity quantity);

/// Factor from `unit` to the SI unit of `quantity`, or nothing if the unit is
/// unknown or of another dimension. A unit is a product or quotient of
///   s ms us ns min h, Hz kHz, m mm um cm km ft, kn mph, rad mrad urad deg mdeg
///   arcmin arcsec, g mg ug Gal mGal, uT nT mT G mG, 1 % ppm
/// with ^n and sqrt(): "deg/sqrt(h)", "m/s^2", "ug/sqrt(Hz)"; also as data sheets
/// write them: dps and mdps, a degree sign, a micro sign, a root sign or rtHz or
/// Hz^0.5, m/s2, words as "degrees" and "sec", " per ". The second is
/// s^-1 of Hz, so "deg/s/sqrt(Hz)" and "rad/sqrt(s)" are the same dimension;
/// an angle is never mistaken for a ratio. A number before it is a multiple, as
/// of counters and buses: "0.1 ms", "0.01 km/h".
std::optional<double> UnitFactor(std::string_view unit, Quantity quantity);

/// "0.23 deg/sqrt(h)" in SI. Throws std::invalid_argument with one line that
/// says what is wrong and which units are accepted; the caller adds the place.
double ParseQuantity(std::string_view text, Quantity quantity);

/// One to many values: "1 deg, 1 deg, 2 deg", "[0, 0.5, -1.1] m", "0, 0.5,
/// -1.1 m": a unit behind the last value or behind the bracket serves those
/// that have none. Throws as ParseQuantity.
std::vector<double> ParseQuantities(std::string_view text, Quantity quantity);

/// Blanks removed at both ends.
std::string_view Trim(std::string_view text);

/// A finite number filling all of `text`, or nothing.
std::optional<double> ParseNumber(std::string_view text);
/// The same into `value`; false if it is none.
bool ReadNumber(std::string_view text, double* value);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_UNITS_H_
