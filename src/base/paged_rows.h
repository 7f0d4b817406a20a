#ifndef HINDSIGHT_BASE_PAGED_ROWS_H_
#define HINDSIGHT_BASE_PAGED_ROWS_H_

#include <algorithm>
#include <cstddef>
#include <utility>

#include "base/scratch_memory.h"

namespace hindsight {

/// As many rows of `width` numbers, zero at first, in ScratchMemory.
class PagedRows {
 public:
  PagedRows() = default;
  PagedRows(std::size_t count, std::size_t width)
      : memory_(count * width * sizeof(double), kBlock),
        count_(count),
        width_(width) {}
  PagedRows(const PagedRows& other) : PagedRows(other.count_, other.width_) {
    for (std::size_t k = 0; k < count_; ++k) {
      std::copy(other.Row(k), other.Row(k) + width_, Row(k));
    }
  }
  PagedRows(PagedRows&& other) noexcept { swap(other); }
  PagedRows& operator=(PagedRows other) noexcept {
    swap(other);
    return *this;
  }
  ~PagedRows() = default;
  void swap(PagedRows& other) noexcept {
    memory_.swap(other.memory_);
    std::swap(count_, other.count_);
    std::swap(width_, other.width_);
  }

  std::size_t size() const { return count_; }
  /// Stays valid; before it is used again after others, it is asked for again.
  double* Row(std::size_t k) {
    memory_.BeforeWriting(FirstBlock(k));
    memory_.BeforeWriting(LastBlock(k));
    return At(k);
  }
  const double* Row(std::size_t k) const {
    memory_.BeforeReading(FirstBlock(k));
    memory_.BeforeReading(LastBlock(k));
    return At(k);
  }

 private:
  static constexpr std::size_t kBlock = std::size_t{1} << 20;  // [bytes]

  double* At(std::size_t k) const {
    return reinterpret_cast<double*>(memory_.data()) + k * width_;
  }
  std::size_t FirstBlock(std::size_t k) const {
    return k * width_ * sizeof(double) / kBlock;
  }
  std::size_t LastBlock(std::size_t k) const {
    return ((k + 1) * width_ * sizeof(double) - 1) / kBlock;
  }

  ScratchMemory memory_;
  std::size_t count_ = 0;
  std::size_t width_ = 0;
};

}  // namespace hindsight

#endif  // HINDSIGHT_BASE_PAGED_ROWS_H_
