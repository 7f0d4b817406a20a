#ifndef HINDSIGHT_BASE_PAGED_VECTOR_H_
#define HINDSIGHT_BASE_PAGED_VECTOR_H_

#include <algorithm>
#include <atomic>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <new>
#include <span>
#include <type_traits>
#include <utility>

#include "base/scratch_memory.h"

namespace hindsight {

/// A std::vector for series that may be larger than memory should be: its elements
/// lie in ScratchMemory, of which walking along it holds a few blocks. Iterators are
/// places: they stay valid, and of the same index, whatever is added.
template <typename T>
class PagedVector {
  static_assert(std::is_trivially_destructible_v<T>);

  static constexpr unsigned kLogBlock = 16;  // elements, of 4096 bytes or more

  template <typename Vector, typename Element>
  class Place {
   public:
    using iterator_category = std::random_access_iterator_tag;
    using value_type = T;
    using difference_type = std::ptrdiff_t;
    using pointer = Element*;
    using reference = Element&;

    Place() = default;
    Place(Vector* vector, std::size_t k) : vector_(vector), k_(k) {}
    /// Of a vector to be read, from one to be changed.
    template <typename Other, typename OtherElement>
    requires std::is_convertible_v<Other*, Vector*>
    // As of every iterator. NOLINTNEXTLINE(google-explicit-constructor)
    Place(const Place<Other, OtherElement>& other)
        : vector_(other.vector_), k_(other.k_) {}

    reference operator*() const { return (*vector_)[k_]; }
    pointer operator->() const { return &(*vector_)[k_]; }
    reference operator[](difference_type n) const { return *(*this + n); }
    Place& operator+=(difference_type n) {
      k_ += static_cast<std::size_t>(n);
      return *this;
    }
    Place& operator-=(difference_type n) { return *this += -n; }
    Place& operator++() { return *this += 1; }
    Place& operator--() { return *this += -1; }
    Place operator++(int) { return std::exchange(*this, *this + 1); }
    Place operator--(int) { return std::exchange(*this, *this - 1); }
    friend Place operator+(Place at, difference_type n) { return at += n; }
    friend Place operator+(difference_type n, Place at) { return at += n; }
    friend Place operator-(Place at, difference_type n) { return at -= n; }
    friend difference_type operator-(const Place& a, const Place& b) {
      return static_cast<difference_type>(a.k_) -
             static_cast<difference_type>(b.k_);
    }
    bool operator==(const Place& other) const { return k_ == other.k_; }
    std::strong_ordering operator<=>(const Place& other) const {
      return k_ <=> other.k_;
    }

   private:
    template <typename, typename>
    friend class Place;

    Vector* vector_ = nullptr;
    std::size_t k_ = 0;
  };

 public:
  using value_type = T;
  using iterator = Place<PagedVector, T>;
  using const_iterator = Place<const PagedVector, const T>;

  PagedVector() = default;
  explicit PagedVector(std::size_t count) { resize(count); }
  PagedVector(std::initializer_list<T> values) {
    assign(values.begin(), values.end());
  }
  PagedVector(const PagedVector& other) { assign(other.begin(), other.end()); }
  PagedVector(PagedVector&& other) noexcept { swap(other); }
  PagedVector& operator=(PagedVector other) noexcept {
    swap(other);
    return *this;
  }
  ~PagedVector() = default;
  void swap(PagedVector& other) noexcept {
    memory_.swap(other.memory_);
    std::swap(size_, other.size_);
    std::swap(capacity_, other.capacity_);
    const std::uint64_t version = version_;
    version_ = other.version_.load();
    other.version_ = version;
  }

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  const T& operator[](std::size_t k) const {
    memory_.BeforeReading(k >> kLogBlock);
    return *At(k);
  }
  T& operator[](std::size_t k) {
    Change();
    memory_.BeforeWriting(k >> kLogBlock);
    return *At(k);
  }
  /// Elements from k on that lie side by side, one at least; to be read before
  /// anything is changed.
  std::span<const T> Piece(std::size_t k) const {
    const std::size_t block = k >> kLogBlock;
    memory_.BeforeReading(block);
    return {At(k), std::min(size_, (block + 1) << kLogBlock) - k};
  }
  /// A number of what it holds: no other vector has it, nor this one once it is
  /// changed, or an element was asked for that could be.
  std::uint64_t version() const {
    static std::atomic<std::uint64_t> last = 0;
    std::uint64_t version = version_;
    if (version != kUnnumbered) return version;
    const std::uint64_t next = ++last;
    return version_.compare_exchange_strong(version, next) ? next : version;
  }
  const T& front() const { return (*this)[0]; }
  T& front() { return (*this)[0]; }
  const T& back() const { return (*this)[size_ - 1]; }
  T& back() { return (*this)[size_ - 1]; }
  iterator begin() { return {this, 0}; }
  iterator end() { return {this, size_}; }
  const_iterator begin() const { return {this, 0}; }
  const_iterator end() const { return {this, size_}; }

  void reserve(std::size_t count) {
    if (count <= capacity_) return;
    PagedVector larger;
    larger.memory_ = ScratchMemory(count * sizeof(T), sizeof(T) << kLogBlock,
                                   ScratchMemory::AtFirst::kAnything);
    larger.capacity_ = count;
    for (const T& value : std::as_const(*this)) larger.push_back(value);
    swap(larger);
  }
  void push_back(const T& value) { emplace_back(value); }
  template <typename... Values>
  T& emplace_back(Values&&... values) {
    // Made beforehand: a value of this vector moves with it.
    T made{std::forward<Values>(values)...};
    Change();
    if (size_ == capacity_) reserve(std::max<std::size_t>(16, 2 * capacity_));
    memory_.BeforeWriting(size_ >> kLogBlock);
    return *new (At(size_++)) T(made);
  }
  void pop_back() {
    Change();
    --size_;
  }
  void resize(std::size_t count, const T& value = T()) {
    Change();
    reserve(count);
    while (size_ < count) push_back(value);
    size_ = count;
  }
  template <typename Iterator>
  void assign(Iterator first, Iterator last) {
    PagedVector values;
    values.reserve(static_cast<std::size_t>(std::distance(first, last)));
    for (; first != last; ++first) values.push_back(*first);
    swap(values);
  }
  void clear() {
    Change();
    size_ = 0;
  }
  /// Drops what lies from one place to another.
  void erase(const_iterator first, const_iterator last) {
    if (first == last) return;
    Change();
    std::move(begin() + (last - begin()), end(), begin() + (first - begin()));
    size_ -= static_cast<std::size_t>(last - first);
  }

 private:
  static constexpr std::uint64_t kUnnumbered = 0;

  T* At(std::size_t k) const {
    return reinterpret_cast<T*>(memory_.data()) + k;
  }
  void Change() { version_.store(kUnnumbered, std::memory_order_relaxed); }

  ScratchMemory memory_;
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;
  mutable std::atomic<std::uint64_t> version_ = kUnnumbered;
};

/// Drops the elements of which `drop` is true.
template <typename T, typename Predicate>
void EraseIf(Predicate drop, PagedVector<T>* vector) {
  vector->erase(std::remove_if(vector->begin(), vector->end(), drop),
                vector->end());
}

}  // namespace hindsight

#endif  // HINDSIGHT_BASE_PAGED_VECTOR_H_
