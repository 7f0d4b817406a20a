#include "io/read/csv_records.h"

#include <algorithm>

#include "base/error.h"
#include "base/text.h"
#include "io/read/text_file.h"
#include "io/read/units.h"

namespace hindsight {
namespace {

/// Takes the field that begins at `*at`, up to the comma or the end of line
/// that ends it.
std::string TakeField(const std::string& path, const std::string& text,
                      long* line, std::size_t* at) {
  const auto is_blank = [&] { return text[*at] == ' ' || text[*at] == '\t'; };
  while (*at < text.size() && is_blank()) ++*at;
  if (*at == text.size() || text[*at] != '"') {
    const std::size_t end =
        std::min(text.find_first_of(",\n", *at), text.size());
    std::string_view field = std::string_view(text).substr(*at, end - *at);
    *at = end;
    if (field.ends_with('\r')) field.remove_suffix(1);
    return std::string(Trim(field));
  }
  const long begin = *line;
  std::string field;
  for (++*at; *at < text.size(); ++*at) {
    const bool is_quote = text[*at] == '"';
    if (is_quote && *at + 1 < text.size() && text[*at + 1] == '"') {
      ++*at;
    } else if (is_quote) {
      break;
    }
    if (text[*at] == '\n') ++*line;
    field += text[*at];
  }
  const std::size_t end = std::min(text.find_first_of(",\n", *at), text.size());
  const bool closed = *at < text.size();
  const std::string_view rest =
      closed ? Trim(std::string_view(text).substr(*at + 1, end - *at - 1)) : "";
  if (!closed || (!rest.empty() && rest != "\r")) {
    throw InputError(path, begin, "expected a comma after the closing quote");
  }
  *at = end;
  return field;
}

}  // namespace

std::vector<CsvRecord> ReadCsvRecords(const std::string& path) {
  const std::string text = ReadTextFile(path);
  std::vector<CsvRecord> records;
  std::size_t at = text.starts_with("\xEF\xBB\xBF") ? 3 : 0;
  for (long line = 1; at < text.size(); ++line, ++at) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view all =
        Trim(std::string_view(text).substr(at, end - at));
    if (all.empty() || all == "\r" || all.starts_with('#')) {
      at = end;
      continue;
    }
    CsvRecord record = {line, {TakeField(path, text, &line, &at)}};
    while (at < text.size() && text[at] == ',') {
      ++at;
      record.fields.push_back(TakeField(path, text, &line, &at));
    }
    if (!records.empty() &&
        record.fields.size() != records.front().fields.size()) {
      throw InputError(path, record.line,
                       std::to_string(record.fields.size()) +
                           " fields where the first line has " +
                           std::to_string(records.front().fields.size()));
    }
    records.push_back(std::move(record));
  }
  return records;
}

}  // namespace hindsight
