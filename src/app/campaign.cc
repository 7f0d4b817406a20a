#include "app/campaign.h"

#include <algorithm>
#include <system_error>
#include <thread>
#include <utility>

#include "app/build_id.h"
#include "app/error_line.h"
#include "base/parallel.h"
#include "io/write/output_error.h"
#include "io/write/result_manifest.h"
#include "io/write/unpublished.h"

namespace hindsight {
namespace fs = std::filesystem;
namespace {

constexpr std::chrono::seconds kLookAgain(1);  // at what others work on

std::vector<std::string> RunWords(const CampaignItem& item,
                                  const ItemPlace& place, int threads) {
  std::vector<std::string> words = {"run",
                                    item.config.string(),
                                    "--out=" + place.results.string(),
                                    "--force",
                                    "--clean",
                                    "--progress=none",
                                    "--threads=" + std::to_string(threads)};
  for (const auto& [name, value] : item.flags) {
    words.push_back("--" + name + "=" + value);
  }
  return words;
}

void MakeFolder(const fs::path& folder) {
  std::error_code refused;
  fs::create_directories(folder, refused);
  if (refused) throw OutputError(folder, refused.message());
}

}  // namespace

std::optional<ItemRecord> RecordOf(const CampaignItem& item,
                                   const ItemPlace& place) {
  std::optional<ItemRecord> record = ReadItemRecord(place);
  if (!record || IsCertainlyOf(*record, item)) return record;
  if (KeyOf(item, record->key).sha256 != record->key.sha256) record.reset();
  return record;
}

Campaign::Campaign(std::vector<CampaignItem> items, CampaignOptions options)
    : items_(std::move(items)), options_(std::move(options)) {
  for (std::size_t i = 0; i < items_.size(); ++i) {
    waiting_.push_back({i, Clock::time_point::min()});
  }
}

void Campaign::Work() {
  std::thread heart([this] { KeepClaimsAlive(); });
  std::vector<std::thread> threads;
  for (int i = 0; i < options_.workers; ++i) {
    threads.emplace_back([this] { Worker(); });
  }
  for (std::thread& thread : threads) thread.join();
  {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
  }
  changed_.notify_all();
  heart.join();
}

void Campaign::Stop() {
  constexpr int kMostSeconds = 30;
  std::unique_lock lock(mutex_);
  is_stopped_ = true;
  changed_.notify_all();
  for (int i = 0; i < kMostSeconds && under_way_ > 0; ++i) {
    // Again and again: a process that was only just made may not have heard.
    children_.Stop();
    changed_.wait_for(lock, std::chrono::seconds(1),
                      [this] { return under_way_ == 0; });
  }
}

/// Whether there is an item to look at, which then is under way.
bool Campaign::Next(Waiting* next) {
  std::unique_lock lock(mutex_);
  while (!is_stopped_) {
    if (waiting_.empty() && under_way_ == 0) return false;
    if (waiting_.empty()) {
      changed_.wait(lock);
    } else if (waiting_.front().not_before > Clock::now()) {
      changed_.wait_until(lock, waiting_.front().not_before);
    } else {
      *next = waiting_.front();
      waiting_.pop_front();
      ++under_way_;
      return true;
    }
  }
  return false;
}

void Campaign::Worker() {
  Waiting next = {};
  while (Next(&next)) {
    bool has_ended = true;
    try {
      has_ended = Try(next.item);
    } catch (const std::exception& error) {
      PrintNote("item " + items_[next.item].name +
                " is left open: " + error.what());
    }
    const std::lock_guard lock(mutex_);
    --under_way_;
    if (has_ended) {
      ++ended_;
      if (options_.progress && !is_stopped_) {
        options_.progress(static_cast<double>(ended_) /
                          static_cast<double>(items_.size()));
      }
    } else {
      waiting_.push_back({next.item, Clock::now() + kLookAgain});
    }
    changed_.notify_all();
  }
}

/// Whether no more is to be done; false if somebody else is at it.
bool Campaign::Try(std::size_t i) {
  const CampaignItem& item = items_[i];
  const ItemPlace place(options_.folder, item);
  const std::optional<ItemRecord> record = ReadItemRecord(place);
  if (record && IsCertainlyOf(*record, item)) return true;
  MakeFolder(place.folder);
  std::optional<Claim> claim = Claim::Take(place.folder, options_.stale_after);
  if (!claim) return false;
  {
    const std::lock_guard lock(mutex_);
    claims_.insert(&*claim);
  }
  const auto forget = [&] {
    const std::lock_guard lock(mutex_);
    claims_.erase(&*claim);
  };
  try {
    Do(i, place, &*claim);
  } catch (...) {
    forget();
    throw;
  }
  forget();
  return true;
}

/// With the claim; somebody may have ended the item just before it was made.
void Campaign::Do(std::size_t i, const ItemPlace& place, Claim* claim) {
  const CampaignItem& item = items_[i];
  for (const fs::path& unfinished : FindAbandoned(place.record)) {
    std::error_code gone;
    fs::remove(unfinished, gone);
  }
  std::optional<ItemRecord> before = ReadItemRecord(place);
  if (before && IsCertainlyOf(*before, item)) return;
  ItemRecord record;
  record.key = KeyOf(item, before ? before->key : ItemKey());
  record.build = BuildId();
  record.flags = item.flags;
  if (before && before->key.sha256 == record.key.sha256) {
    // The same content under other times.
    before->key = record.key;
    WriteItemRecord(*before, place);
    return;
  }
  if (claim->note_before() == record.key.sha256 &&
      TakeResults(place, &record)) {
    WriteItemRecord(record, place);
    return;
  }
  // From here on complete results are those of the claim's note.
  if (const auto old = ReadManifest(place.results); old && old->complete) {
    RemoveListed(place.results);
  }
  claim->Note(record.key.sha256);
  if (Run(i, place, *claim, &record)) WriteItemRecord(record, place);
}

/// Whether the item has ended; false if it was stopped, or is another's by now.
bool Campaign::Run(std::size_t i, const ItemPlace& place, const Claim& claim,
                   ItemRecord* record) {
  const int threads = std::max(1, ThreadCount() / options_.workers);
  const ChildEnd end = children_.Run(RunWords(items_[i], place, threads),
                                     place.log, options_.limits);
  if (children_.stopped() || !claim.Beat()) return false;
  record->seconds = end.seconds;
  record->megabytes = end.megabytes;
  const bool has_answer =
      end.signal == 0 && !end.over_time && end.status != kNotWritten;
  if (!has_answer || !TakeResults(place, record)) {
    record->reason = FailureOf(end, options_.limits, place);
  }
  return true;
}

void Campaign::KeepClaimsAlive() {
  constexpr double kOften = 5.0;  // [s]
  const std::chrono::duration<double> pause(
      std::min(kOften, options_.stale_after / 4.0));
  std::unique_lock lock(mutex_);
  while (!changed_.wait_for(lock, pause, [this] { return is_over_; })) {
    for (const Claim* claim : claims_) claim->Beat();
  }
}

}  // namespace hindsight
