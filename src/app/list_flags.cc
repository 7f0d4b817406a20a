#include "app/list_flags.h"

#include <algorithm>
#include <stdexcept>

#include "app/flags.h"
#include "io/read/units.h"

namespace hindsight {
namespace {

template <typename T>
bool Contains(const std::vector<T>& list, const T& value) {
  return std::find(list.begin(), list.end(), value) != list.end();
}

}  // namespace

UsageError BadFlag(const std::string& flag, const std::string& value,
                   const std::string& what) {
  return UsageError("--" + flag + "=" + value + ": " + what);
}

bool IsOutOfRange(const std::string& text) {
  try {
    std::stod(text);
  } catch (const std::out_of_range&) {
    return true;
  } catch (const std::invalid_argument&) {
  }
  return false;
}

std::vector<std::string> ReadWords(const std::string& flag,
                                   const std::string& value) {
  std::vector<std::string> words;
  for (const std::string& word : Split(value, ',')) {
    if (word.empty()) throw BadFlag(flag, value, "nothing beside a comma");
    if (Contains(words, word)) {
      throw BadFlag(flag, value, "'" + word + "' stands there twice");
    }
    words.push_back(word);
  }
  return words;
}

std::vector<double> ReadPositiveNumbers(const std::string& flag,
                                        const std::string& value) {
  std::vector<double> numbers;
  for (const std::string& word : ReadWords(flag, value)) {
    if (IsOutOfRange(word)) {
      throw BadFlag(flag, value, "'" + word + "' is out of range");
    }
    const auto number = ParseNumber(word);
    if (!number || !(*number > 0.0)) {
      throw BadFlag(flag, value, "'" + word + "' is not a positive number");
    }
    if (Contains(numbers, *number)) {
      throw BadFlag(flag, value, "'" + word + "' stands there twice");
    }
    numbers.push_back(*number);
  }
  if (numbers.empty()) throw BadFlag(flag, value, "expected positive numbers");
  return numbers;
}

}  // namespace hindsight
