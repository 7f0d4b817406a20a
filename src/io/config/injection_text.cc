#include "io/config/injection_text.h"

#include <algorithm>
#include <array>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "dataset/injection.h"
#include "io/read/units.h"

namespace hindsight {
namespace {

/// Between commas, blanks trimmed.
std::vector<std::string> Parts(std::string_view text) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    parts.emplace_back(Trim(text.substr(begin, end - begin)));
    begin = end + 1;
  }
  return parts;
}

/// One injection, key by key.
class InjectionParser {
 public:
  explicit InjectionParser(const std::string& text) : text_(text) {}

  Injection Parse() {
    const std::size_t colon = text_.find(':');
    if (colon == 0 || colon == std::string::npos) Fail("no sensor");
    injection_.sensor = text_.substr(0, colon);
    for (const std::string& part : Parts(text_.substr(colon + 1))) {
      const std::size_t equals = std::min(part.find('='), part.size());
      const std::string key = part.substr(0, equals);
      if (!keys_.insert(key).second) Fail("'" + key + "' stands there twice");
      Take(key, part.substr(std::min(equals + 1, part.size())));
    }
    CheckSize();
    CheckKeys();
    const std::string objection = SpanObjection(injection_);
    if (!objection.empty()) Fail(objection);
    return injection_;
  }

 private:
  [[noreturn]] void Fail(const std::string& what) const {
    throw std::invalid_argument(
        what +
        "; expected SENSOR:KIND=SIZE[,from=140s][,to=150s]"
        "[,axes=ne], KIND step, pulse, ramp, spikes (with "
        "[,share=10%]) or multipath (with [,tau=20s])");
  }

  double Value(const std::string& text, Quantity quantity) const {
    try {
      return ParseQuantity(text, quantity);
    } catch (const std::invalid_argument& error) {
      Fail("'" + text + "': " + error.what());
    }
  }

  void Take(const std::string& key, const std::string& value) {
    static const std::vector<std::pair<std::string, Injection::Kind>> kinds = {
        {"step", Injection::Kind::kStep},
        {"pulse", Injection::Kind::kPulse},
        {"ramp", Injection::Kind::kRamp},
        {"spikes", Injection::Kind::kSpikes},
        {"multipath", Injection::Kind::kMultipath}};
    for (const auto& [name, kind] : kinds) {
      if (key != name) continue;
      if (!kind_.empty()) Fail("more than one kind of error");
      kind_ = key;
      injection_.kind = kind;
      TakeSize(value);
      return;
    }
    if (key == "from") {
      injection_.from = Value(value, Quantity::kTime);
    } else if (key == "to") {
      injection_.to = Value(value, Quantity::kTime);
    } else if (key == "tau") {
      injection_.tau = Value(value, Quantity::kTime);
      if (injection_.tau <= 0.0) Fail("tau must be positive");
    } else if (key == "share") {
      injection_.share = Value(value, Quantity::kRatio);
      if (injection_.share <= 0.0 || injection_.share > 1.0) {
        Fail("share must be above 0 and at most 100 %");
      }
    } else if (key == "axes") {
      TakeAxes(value);
    } else {
      Fail("unknown key '" + key + "'");
    }
  }

  /// The sensor, which says what unit it must be, is known only once the
  /// recording is read.
  void TakeSize(const std::string& value) {
    for (const Quantity quantity : {Quantity::kLength, Quantity::kSpeed}) {
      try {
        injection_.size = ParseQuantity(value, quantity);
        injection_.speed = quantity == Quantity::kSpeed;
        return;
      } catch (const std::invalid_argument&) {
      }
    }
    Fail("'" + value + "' is neither a length, as 12m, nor a speed, as 0.5m/s");
  }

  void TakeAxes(const std::string& value) {
    const std::string names = "ned";
    std::array<bool, 3>& axes = injection_.axes.emplace();
    for (const char c : value) {
      const std::size_t axis = names.find(c);
      if (axis == std::string::npos) Fail("axes are of n, e, d");
      if (axes[axis]) Fail("axis " + names.substr(axis, 1) + " stands twice");
      axes[axis] = true;
    }
    if (value.empty()) Fail("axes are of n, e, d");
  }

  void CheckSize() const {
    if (kind_.empty()) Fail("no kind of error");
    if (injection_.size == 0.0) Fail("an error of zero");
    const bool is_signed = kind_ != "spikes" && kind_ != "multipath";
    if (!is_signed && injection_.size < 0.0) {
      Fail("the signs of " + kind_ + " are drawn; its size must be positive");
    }
  }

  void CheckKeys() const {
    for (const auto& [key, kind] :
         {std::pair("share", "spikes"), std::pair("tau", "multipath")}) {
      if (keys_.contains(key) && kind_ != kind) {
        Fail(std::string(key) + " goes with " + kind + ", not with " + kind_);
      }
    }
  }

  const std::string& text_;
  Injection injection_;
  std::set<std::string> keys_;
  std::string kind_;  ///< as it is written; empty: none yet
};

}  // namespace

Injection ParseInjection(const std::string& text) {
  return InjectionParser(text).Parse();
}

}  // namespace hindsight
