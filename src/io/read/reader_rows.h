#ifndef HINDSIGHT_IO_READ_READER_ROWS_H_
#define HINDSIGHT_IO_READ_READER_ROWS_H_

#include <string>
#include <utility>
#include <vector>

#include "io/read/reader.h"

namespace hindsight {

/// Rows of one stream in time order, under its policies.
class StreamRows {
 public:
  StreamRows(const StreamSource& source, const std::vector<FieldName>& fields,
             bool allow_absent);

  enum class Step {
    kEnd,      ///< there are no more rows
    kAppend,   ///< a row later than the last
    kReplace,  ///< a row that takes the place of the last (drop_first)
  };
  /// Reads on. Throws InputError for time that runs backwards, for repeated
  /// stamps without a policy and for values out of all proportion: beyond
  /// 1e9 m, 1e6 m/s, 1e6 m/s^2, 1e6 rad, 1e5 rad/s or 1e6 uT.
  Step Next();

  const RowSource& table() const { return *opened_.table; }
  const OpenedTable& opened() const { return opened_; }
  /// Time of the row since the first row [s].
  double t() const { return t_; }
  /// Time since the row before [s]; zero for the first.
  double dt() const { return dt_; }
  const StreamClock& clock() const { return clock_; }

  /// Appends what the policies did.
  void CountPolicies(std::vector<PolicyCount>* policies) const;

 private:
  Stamp FileTime();
  /// Throws InputError for a value that no vehicle on Earth has.
  void CheckSizes() const;
  /// Throws InputError: the file `part` begins before the one before ends.
  [[noreturn]] void FailOverlap(std::size_t part) const;
  void Sort(const std::vector<FieldName>& fields, bool allow_absent);

  const StreamSource& source_;
  const std::vector<FieldName>& fields_;
  /// Of a field that the file holds.
  struct LargestSize {
    std::size_t field;
    double most;
  };
  std::vector<LargestSize> most_;
  OpenedTable opened_;
  StreamClock clock_;
  double t_ = 0.0;
  double dt_ = 0.0;
  long rows_ = 0;
  std::size_t part_ = 0;  ///< of the last row that was used
  bool started_ = false;
  long duplicates_ = 0;
  long sorted_ = 0;
  long outside_ = 0;
  std::int64_t weeks_ = 0;
  std::optional<Stamp> last_stamp_;
};

/// Adds an entry if count is positive.
void AddPolicy(const std::string& stream, const std::string& action, long count,
               std::vector<PolicyCount>* policies);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_READER_ROWS_H_
