#include "state/evidence.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hindsight {

const char* GradeName(Grade grade) {
  switch (grade) {
    case Grade::kUsable:
      return "usable";
    case Grade::kDoubtful:
      return "doubtful";
    case Grade::kUnusable:
      return "not usable";
  }
  return "";
}

double Evidence::Severity() const {
  if (!value || !limit || *limit == 0.0 || !std::isfinite(*value)) {
    return std::numeric_limits<double>::infinity();
  }
  return std::abs(*value / *limit);
}

Grade GradeOf(const std::vector<Evidence>& evidence) {
  Grade worst = Grade::kUsable;
  for (const Evidence& e : evidence) worst = std::max(worst, e.grade);
  return worst;
}

std::string AsAlternatives(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    text += i == 0 ? "" : i + 1 < words.size() ? ", " : " or ";
    text += words[i];
  }
  return text;
}

std::vector<std::string> WhatToTry(const Evidence& evidence) {
  std::vector<std::string> words = evidence.remedies;
  if (!evidence.better_methods.empty()) {
    words.insert(words.begin(),
                 "method " + AsAlternatives(evidence.better_methods));
  }
  return words;
}

std::string Describe(const Evidence& evidence) {
  std::string text = evidence.what;
  if (!evidence.causes.empty()) {
    text += "; likely: " + AsAlternatives(evidence.causes);
  }
  const std::vector<std::string> words = WhatToTry(evidence);
  if (!words.empty()) text += "; try: " + AsAlternatives(words);
  return text;
}

}  // namespace hindsight
