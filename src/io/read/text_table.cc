#include "io/read/text_table.h"

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"
#include "io/read/text_tokens.h"
#include "io/read/units.h"

namespace hindsight {
namespace {

/// Lines and bytes that are read ahead at most; at first less, as many a file is
/// looked into for some rows only.
constexpr std::size_t kMostAhead = 8192;
constexpr std::size_t kMostBytesAhead = std::size_t{1} << 22;
/// Times of day that fall back by more have run over midnight [s].
constexpr std::int64_t kHalfDay = 43200;
/// Lines that are worth a thread.
constexpr std::size_t kLinesOfThread = 512;
/// Batches that are parsed at once at most.
constexpr std::size_t kMostBatches = 4;

}  // namespace

TextTable::TextTable(TextLines* lines, TableLayout layout, Options options,
                     std::string first_row)
    : lines_(lines),
      parser_(std::move(layout), options.allow_absent),
      options_(options),
      first_row_(std::move(first_row)) {
  values_.assign(parser_.layout().fields.size(),
                 std::numeric_limits<double>::quiet_NaN());
}

TextTable::Batch TextTable::ReadLines(Batch memory) {
  Batch batch = std::move(memory);
  batch.texts.clear();
  batch.rows.clear();
  batch.problems.clear();
  batch.trouble = nullptr;
  const TableLayout& layout = parser_.layout();
  const auto add = [&](std::string_view line) {
    Ahead& row = batch.rows.emplace_back();
    row.begin = static_cast<std::uint32_t>(batch.texts.size());
    row.length = static_cast<std::uint32_t>(line.size());
    row.number = lines_->number();
    row.terminated = lines_->terminated();
    batch.texts += line;
  };
  if (!first_row_.empty()) {
    add(first_row_);
    first_row_.clear();
  }
  try {
    std::string_view line;
    while (batch.rows.size() < most_ && batch.texts.size() < kMostBytesAhead &&
           lines_->Next(&line)) {
      if (!IsComment(line) && layout.rows.IsIn(line, layout.delimiter)) {
        add(line);
      }
    }
  } catch (const InputError&) {
    batch.trouble = std::current_exception();
  }
  return batch;
}

void TextTable::Parse(Batch* batch) const {
  // One of its own: what a thread reads of each row must not stand, by the chance of
  // where memory was had, beside what another writes with each row.
  const TextRowParser parser = parser_;
  const std::size_t width = values_.size();
  batch->values.resize(batch->rows.size() * width);
  TextRowParser::Scratch scratch;
  std::size_t begin = 0;
  for (Ahead& row : batch->rows) {
    std::size_t last_length = 0;
    std::string problem = parser.Parse(
        std::string_view(batch->texts).substr(row.begin, row.length), &scratch,
        std::span(batch->values).subspan(begin, width), &row.stamp,
        &row.columns, &last_length);
    row.last_length = static_cast<std::uint32_t>(last_length);
    begin += width;
    if (problem.empty()) continue;
    row.problem = static_cast<std::uint32_t>(batch->problems.size());
    batch->problems.push_back(std::move(problem));
  }
}

bool TextTable::ReadAhead() {
  elsewhere_ = nullptr;
  if (batch_.trouble) std::rethrow_exception(batch_.trouble);
  Batch used = std::move(batch_);
  if (ahead_.empty()) {
    batch_ = ReadLines(std::exchange(used, {}));
    Parse(&batch_);
  } else {
    batch_ = ahead_.front().get();
    ahead_.pop_front();
  }
  taken_ = 0;
  if (batch_.rows.empty() && batch_.trouble) {
    std::rethrow_exception(batch_.trouble);
  }
  // The first good row tells how many columns the others must have.
  if (parser_.layout().column_count > 0) {
    most_ = std::min(2 * most_, kMostAhead);
    if (most_ >= kLinesOfThread) GoAhead(std::move(used));
  }
  return !batch_.rows.empty();
}

void TextTable::GoAhead(Batch memory) {
  const std::size_t most =
      std::min(static_cast<std::size_t>(ThreadCount()), kMostBatches);
  while (!all_read_ && ahead_.size() < most) {
    Batch next = ReadLines(std::exchange(memory, {}));
    all_read_ = next.rows.empty() || next.trouble;
    ahead_.push_back(InBackground([this, batch = std::move(next)]() mutable {
      Parse(&batch);
      return std::move(batch);
    }));
  }
}

void TextTable::Take(const Ahead& row, std::size_t index) {
  if (parser_.layout().column_count == 0) parser_.FixColumnCount(row.columns);
  const std::int64_t before = stamp_.seconds;
  stamp_ = row.stamp;
  if (parser_.layout().clock == TableLayout::Clock::kOfDay) {
    stamp_.seconds += midnight_;
    if (stamp_.seconds < before - kHalfDay) {
      midnight_ += 2 * kHalfDay;
      stamp_.seconds += 2 * kHalfDay;
    }
  }
  elsewhere_ = batch_.values.data() + index * values_.size();
}

bool TextTable::Next() {
  std::string problem;
  while (true) {
    if (taken_ == batch_.rows.size() && !ReadAhead()) return false;
    const std::size_t index = taken_++;
    const Ahead& row = batch_.rows[index];
    line_ = row.number;
    terminated_ = row.terminated;
    if (first_length_ == 0) first_length_ = row.length + 1;
    problem.clear();
    if (row.problem != kNone) problem = batch_.problems[row.problem];
    if (problem.empty() && IsLastValueWhole(row, &problem)) {
      Take(row, index);
      return true;
    }
    const bool cut = !terminated_ && options_.allow_truncated_tail;
    if (!options_.drop_text || cut) {
      const TableLayout& layout = parser_.layout();
      if (layout.column_count == 0 &&
          HoldsNoNumber(LineOf(row), layout.delimiter)) {
        problem +=
            "; a line of titles above columns that are counted is passed "
            "over by skip_lines: " +
            std::to_string(line_);
      }
      break;
    }
    ++texts_dropped_;
  }
  if (terminated_) Fail(problem);
  if (!options_.allow_truncated_tail) {
    Fail("the last line is truncated: " + problem +
         " (allow_truncated_tail: true drops it)");
  }
  ++truncated_;
  return false;
}

bool TextTable::IsLastValueWhole(const Ahead& row, std::string* problem) {
  if (parser_.wanted() == 0 ||
      row.columns != static_cast<int>(parser_.wanted())) {
    return true;
  }
  const std::uint32_t length = row.last_length;
  if (!row.terminated && length < shortest_last_value_ &&
      shortest_last_value_ != kNone) {
    const std::string_view line = LineOf(row);
    *problem = parser_.ColumnName(static_cast<int>(parser_.wanted()) - 1) +
               ": '" + std::string(line.substr(line.size() - length)) +
               "' is shorter than in all lines before, and no line end follows";
    return false;
  }
  shortest_last_value_ = std::min(shortest_last_value_, length);
  return true;
}

std::vector<LeftOut> TextTable::left_out() const {
  std::vector<LeftOut> left_out;
  if (truncated_ > 0) {
    left_out.push_back({"truncated last line dropped", truncated_});
  }
  if (texts_dropped_ > 0)
    left_out.push_back({"row of text dropped", texts_dropped_});
  return left_out;
}

std::size_t TextTable::RowsHint() const {
  // Rows differ in length; a little too much costs address space only.
  return first_length_ == 0
             ? 0
             : lines_->size_hint() / std::max<std::size_t>(first_length_, 2) *
                   11 / 10;
}

}  // namespace hindsight
