#ifndef HINDSIGHT_IO_READ_TITLE_WORDS_H_
#define HINDSIGHT_IO_READ_TITLE_WORDS_H_

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace hindsight {

/// The words of a name in lower case, parted where case, digits or signs
/// change: "positionGt" as position, gt; "AccelXMps" as accel, x, mps.
std::vector<std::string> SplitWords(const std::string& name);

/// Whether one of the words is one of `names`.
bool HasAnyWord(const std::vector<std::string>& words,
                std::initializer_list<std::string_view> names);

/// Takes the unit off a title, "[deg/s]" or "(deg/s)", and gives what stands
/// between the brackets, of several the last; "" without, of an axis, and of a
/// number with more behind it.
std::string TakeBracketedUnit(std::string* title);

/// Takes a unit that stands without brackets off the end of the words of a
/// title, "deg/s" of "gyro, x, dps"; "" if there is none.
std::string TakeUnitWord(std::vector<std::string>* words);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_TITLE_WORDS_H_
