#ifndef HINDSIGHT_STATE_EVIDENCE_H_
#define HINDSIGHT_STATE_EVIDENCE_H_

#include <optional>
#include <string>
#include <vector>

namespace hindsight {

/// How far a result, or a recording, is to be believed; worse ones are greater.
enum class Grade {
  kUsable,    ///< trajectory and sigmas are to be taken at their word
  kDoubtful,  ///< something contradicts them that may or may not matter
  kUnusable   ///< the trajectory, or its sigmas, are wrong or say nothing
};

/// "usable", "doubtful", "not usable".
const char* GradeName(Grade grade);

/// One thing that is known of a result without any truth, and what it means.
struct Evidence {
  std::string rule = "";  ///< that found it, as in evaluation/grade.h
  /// The best grade that a result with this evidence can have.
  Grade grade = Grade::kUsable;
  std::string what = "";  ///< one clause in words, with its figure
  /// The figure and the value beyond which it lowers the grade, both in `unit`.
  std::optional<double> value = std::nullopt;
  std::optional<double> limit = std::nullopt;
  std::string unit = "";  ///< "sigma", "m", "deg", "s", "%", "1"
  std::optional<double> t_begin =
      std::nullopt;  ///< of the time that it speaks of [s]
  std::optional<double> t_end = std::nullopt;  ///< [s]
  std::vector<std::string> causes = {};        ///< the likely ones
  std::vector<std::string> remedies = {};      ///< what to try
  /// Methods that do not suffer from it.
  std::vector<std::string> better_methods = {};
  /// What else is odd of a solution may well be its consequence: a fault that
  /// the recording shows by itself, a given start that is not so, a sensor that
  /// was shut out.
  bool is_cause = false;
  /// The verdict names it also where another says more.
  bool is_always_told = false;
  /// The other method that it says the same of; empty: none.
  std::string against = "";

  /// Value over limit; infinite of what has no limit to be within.
  double Severity() const;
};

/// The worst grade among the evidence; usable if there is none.
Grade GradeOf(const std::vector<Evidence>& evidence);

/// "a", "a or b", "a, b or c".
std::string AsAlternatives(const std::vector<std::string>& words);

/// All that there is to try: better methods first.
std::vector<std::string> WhatToTry(const Evidence& evidence);

/// "WHAT; likely: CAUSE or CAUSE; try: REMEDY or REMEDY".
std::string Describe(const Evidence& evidence);

}  // namespace hindsight

#endif  // HINDSIGHT_STATE_EVIDENCE_H_
