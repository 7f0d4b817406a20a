#ifndef HINDSIGHT_BASE_PACKED_SERIES_H_
#define HINDSIGHT_BASE_PACKED_SERIES_H_

#include <array>
#include <cstddef>
#include <iterator>
#include <utility>
#include <vector>

#include "base/packed_words.h"

namespace hindsight {

/// Rows of one kind in little memory (PackedColumns), handed out by value, bit
/// for bit what was put in. A row is a copy: what refers into it must not
/// outlive it, and it is changed through Edited() and Edit().
template <class Row>
class PackedSeries {
 public:
  class Iterator {
   public:
    using iterator_category = std::random_access_iterator_tag;
    using value_type = Row;
    using difference_type = std::ptrdiff_t;
    using reference = const Row;
    class pointer {  // NOLINT(readability-identifier-naming): as in std
     public:
      explicit pointer(const Row& row) : row_(row) {}
      const Row* operator->() const { return &row_; }

     private:
      Row row_;
    };

    Iterator() = default;
    Iterator(const PackedSeries* series, std::size_t i)
        : series_(series), i_(static_cast<difference_type>(i)) {}
    reference operator*() const { return (*this)[0]; }
    pointer operator->() const { return pointer(**this); }
    reference operator[](difference_type n) const {
      return (*series_)[static_cast<std::size_t>(i_ + n)];
    }
    Iterator& operator+=(difference_type n) {
      i_ += n;
      return *this;
    }
    Iterator& operator-=(difference_type n) { return *this += -n; }
    Iterator& operator++() { return *this += 1; }
    Iterator& operator--() { return *this += -1; }
    Iterator operator++(int) { return std::exchange(*this, *this + 1); }
    Iterator operator--(int) { return std::exchange(*this, *this - 1); }
    friend Iterator operator+(Iterator it, difference_type n) {
      return it += n;
    }
    friend Iterator operator+(difference_type n, Iterator it) {
      return it += n;
    }
    friend Iterator operator-(Iterator it, difference_type n) {
      return it -= n;
    }
    friend difference_type operator-(const Iterator& a, const Iterator& b) {
      return a.i_ - b.i_;
    }
    friend auto operator<=>(const Iterator& a, const Iterator& b) {
      return a.i_ <=> b.i_;
    }
    friend bool operator==(const Iterator& a, const Iterator& b) {
      return a.i_ == b.i_;
    }

   private:
    const PackedSeries* series_ = nullptr;
    difference_type i_ = 0;
  };
  using value_type = Row;
  using const_iterator = Iterator;

  PackedSeries() = default;
  explicit PackedSeries(const std::vector<Row>& rows) {
    for (const Row& row : rows) push_back(row);
  }

  std::size_t size() const { return columns_.size(); }
  bool empty() const { return size() == 0; }
  // Constant, so that to assign to a part of a copy does not compile.
  const Row operator[](std::size_t i) const {
    Words words;
    columns_.Read(i, words);
    Row row;
    WordsOf<Row>::Take(words.data(), &row);
    return row;
  }
  const Row front() const { return (*this)[0]; }
  const Row back() const { return (*this)[size() - 1]; }
  Iterator begin() const { return {this, 0}; }
  Iterator end() const { return {this, size()}; }

  void push_back(const Row& row) { columns_.Append(Pack(row)); }
  void pop_back() { columns_.PopBack(); }
  void clear() { *this = {}; }

  /// Changes row i: edit(Row&).
  template <class F>
  void Edit(std::size_t i, F edit) {
    Editor editor(this, i);
    edit(*editor);
  }

  /// All rows to be changed in their order, each put back when the loop goes on
  /// or ends:
  ///   for (Row& row : series.Edited()) row.t += dt;
  auto Edited() {
    struct Range {
      PackedSeries* series;
      auto begin() const { return Editor(series, 0); }
      auto end() const { return std::default_sentinel; }
    };
    return Range{this};
  }

  template <class Predicate>
  void EraseIf(Predicate predicate) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < size(); ++i) {
      const Row row = (*this)[i];
      if (predicate(row)) continue;
      if (kept < i) columns_.Write(kept, Pack(row));
      ++kept;
    }
    while (size() > kept) pop_back();
  }

 private:
  using Words = std::array<PackedWord, WordsOf<Row>::kCount>;

  static Words Pack(const Row& row) {
    Words words;
    WordsOf<Row>::Put(row, words.data());
    return words;
  }

  class Editor {
   public:
    Editor(PackedSeries* series, std::size_t i) : series_(*series), i_(i) {
      Load();
    }
    Editor(const Editor&) = delete;
    Editor& operator=(const Editor&) = delete;
    ~Editor() { Store(); }  // NOLINT(bugprone-exception-escape): no memory

    Row& operator*() { return row_; }
    Editor& operator++() {
      Store();
      ++i_;
      Load();
      return *this;
    }
    bool operator==(std::default_sentinel_t) const {
      return i_ >= series_.size();
    }

   private:
    void Load() {
      if (i_ >= series_.size()) return;
      series_.columns_.Read(i_, words_);
      WordsOf<Row>::Take(words_.data(), &row_);
    }
    void Store() {
      if (i_ >= series_.size()) return;
      const Words now = Pack(row_);
      if (now != words_) series_.columns_.Write(i_, now);
    }

    PackedSeries& series_;
    std::size_t i_;
    Words words_;  ///< before the change
    Row row_;
  };

  PackedColumns columns_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_BASE_PACKED_SERIES_H_
