#include "problems/method.h"

#include <stdexcept>
#include <string_view>

#include "base/error.h"
#include "evaluation/grade.h"

namespace hindsight {

extern const Method kBatchMethod;
extern const Method kIteratedMethod;
extern const Method kRobustBatchMethod;
extern const Method kRtsMethod;
extern const Method kTwoFilterMethod;
extern const Method kTwoFilterConventionalMethod;
extern const Method kTwoFilterEulerMethod;
extern const Method kImmSmootherMethod;
extern const Method kEkfMethod;
extern const Method kGatedEkfMethod;
extern const Method kImmMethod;
extern const Method kHinfMethod;
extern const Method kModifiedHinfMethod;
extern const Method kAhrsSmootherMethod;
extern const Method kAhrsMethod;

namespace {

std::vector<const Method*>& TheTable() {
  static std::vector<const Method*> table = {
      &kBatchMethod,
      &kIteratedMethod,
      &kRobustBatchMethod,
      &kRtsMethod,
      &kTwoFilterMethod,
      &kTwoFilterConventionalMethod,
      &kTwoFilterEulerMethod,
      &kImmSmootherMethod,
      &kEkfMethod,
      &kGatedEkfMethod,
      &kImmMethod,
      &kHinfMethod,
      &kModifiedHinfMethod,
      &kAhrsSmootherMethod,
      &kAhrsMethod,
  };
  return table;
}

}  // namespace

std::span<const Method* const> Methods() { return TheTable(); }

void AddMethod(const Method& method) {
  for (const Method* known : Methods()) {
    if (std::string_view(known->name) != method.name) continue;
    throw std::invalid_argument("there is a method named " +
                                std::string(method.name));
  }
  TheTable().push_back(&method);
}

const Solution& Best(const std::vector<Solution>& solutions) {
  std::vector<const char*> preference;
  for (const Method* method : Methods()) preference.push_back(method->name);
  return solutions.at(static_cast<std::size_t>(BestOf(solutions, preference)));
}

std::string MethodNames(bool attitude_alone) {
  std::string names;
  for (const Method* method : Methods()) {
    if (method->attitude_alone() != attitude_alone) continue;
    names += (names.empty() ? "" : ", ") + std::string(method->name);
  }
  return names;
}

std::string MethodHelp(bool attitude_alone) {
  constexpr std::size_t kColumn = 17;
  std::string text;
  for (const Method* method : Methods()) {
    if (method->attitude_alone() != attitude_alone) continue;
    std::string line = "  " + std::string(method->name);
    if (line.size() + 1 > kColumn) {
      text += line + "\n";
      line.clear();
    }
    line.resize(kColumn, ' ');
    for (const char* c = method->help; *c != '\0'; ++c) {
      line += *c;
      if (*c == '\n') line.append(kColumn, ' ');
    }
    text += line + "\n";
  }
  return text;
}

const Method& MethodOf(const std::string& name) {
  for (const Method* method : Methods()) {
    if (name == method->name) return *method;
  }
  throw InputError("unknown method '" + name + "'; known are " +
                   MethodNames(false) +
                   "; attitude alone: " + MethodNames(true));
}

}  // namespace hindsight
