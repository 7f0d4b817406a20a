#ifndef HINDSIGHT_BASE_PACKED_WORDS_H_
#define HINDSIGHT_BASE_PACKED_WORDS_H_

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>

#include "base/packed_columns.h"

namespace hindsight {

/// How a value becomes a fixed number of words and those the same value again,
/// bit for bit. A struct lists its fields in one place,
///   template <class Self>
///   static auto Fields(Self& self) { return std::tie(self.t, ...); }
/// which are numbers, flags, enumerations, pointers, Eigen's fixed sizes, and
/// arrays, optional values, alternatives and structs of these.
template <class T>
struct WordsOf {
  using Tuple = decltype(T::Fields(std::declval<T&>()));
  static constexpr std::size_t kCount =
      []<class... F>(std::type_identity<std::tuple<F&...>>) {
        return (WordsOf<F>::kCount + ... + 0);
      }(std::type_identity<Tuple>());

  static void Put(const T& value, PackedWord* words) {
    std::apply(
        [&words]<class... F>(const F&... field) {
          ((WordsOf<F>::Put(field, words), words += WordsOf<F>::kCount), ...);
        },
        T::Fields(value));
  }
  static void Take(const PackedWord* words, T* value) {
    std::apply(
        [&words]<class... F>(F&... field) {
          ((WordsOf<F>::Take(words, &field), words += WordsOf<F>::kCount), ...);
        },
        T::Fields(*value));
  }
};

template <>
struct WordsOf<double> {
  static constexpr std::size_t kCount = 1;
  static void Put(double value, PackedWord* words) {
    *words = std::bit_cast<PackedWord>(value);
  }
  static void Take(const PackedWord* words, double* value) {
    *value = std::bit_cast<double>(*words);
  }
};

template <class T>
requires std::integral<T> || std::is_enum_v<T>
struct WordsOf<T> {
  static constexpr std::size_t kCount = 1;
  static void Put(T value, PackedWord* words) {
    *words = static_cast<PackedWord>(value);
  }
  static void Take(const PackedWord* words, T* value) {
    *value = static_cast<T>(*words);
  }
};

/// The address of an object, which must outlive the words.
template <class T>
struct WordsOf<const T*> {
  static constexpr std::size_t kCount = 1;
  static void Put(const T* value, PackedWord* words) {
    *words = static_cast<PackedWord>(reinterpret_cast<std::uintptr_t>(value));
  }
  static void Take(const PackedWord* words, const T** value) {
    *value = reinterpret_cast<const T*>(static_cast<std::uintptr_t>(*words));
  }
};

template <class T, std::size_t N>
struct WordsOf<std::array<T, N>> {
  static constexpr std::size_t kCount = N * WordsOf<T>::kCount;
  static void Put(const std::array<T, N>& value, PackedWord* words) {
    for (std::size_t i = 0; i < N; ++i) {
      WordsOf<T>::Put(value[i], words + i * WordsOf<T>::kCount);
    }
  }
  static void Take(const PackedWord* words, std::array<T, N>* value) {
    for (std::size_t i = 0; i < N; ++i) {
      WordsOf<T>::Take(words + i * WordsOf<T>::kCount, &(*value)[i]);
    }
  }
};

/// Of a square matrix what lies below the diagonal as its difference from what
/// lies above, which is nothing in a covariance.
template <int R, int C, int O>
struct WordsOf<Eigen::Matrix<double, R, C, O>> {
  using M = Eigen::Matrix<double, R, C, O>;
  static constexpr std::size_t kCount = std::size_t{R} * std::size_t{C};
  static PackedWord Above(const M& value, int i, int j) {
    return R == C && i > j ? std::bit_cast<PackedWord>(value(j, i)) : 0;
  }
  static void Put(const M& value, PackedWord* words) {
    for (int i = 0; i < R; ++i) {
      for (int j = 0; j < C; ++j) {
        *words++ = std::bit_cast<PackedWord>(value(i, j)) - Above(value, i, j);
      }
    }
  }
  static void Take(const PackedWord* words, M* value) {
    for (int i = 0; i < R; ++i) {
      for (int j = 0; j < C; ++j) {
        (*value)(i, j) = std::bit_cast<double>(*words++ + Above(*value, i, j));
      }
    }
  }
};

template <>
struct WordsOf<Eigen::Quaterniond> {
  using Coefficients = WordsOf<Eigen::Vector4d>;
  static constexpr std::size_t kCount = Coefficients::kCount;
  static void Put(const Eigen::Quaterniond& value, PackedWord* words) {
    Coefficients::Put(value.coeffs(), words);
  }
  static void Take(const PackedWord* words, Eigen::Quaterniond* value) {
    Coefficients::Take(words, &value->coeffs());
  }
};

template <class T>
struct WordsOf<std::optional<T>> {
  static constexpr std::size_t kCount = 1 + WordsOf<T>::kCount;
  static void Put(const std::optional<T>& value, PackedWord* words) {
    std::fill_n(words, kCount, 0);
    if (!value) return;
    words[0] = 1;
    WordsOf<T>::Put(*value, words + 1);
  }
  static void Take(const PackedWord* words, std::optional<T>* value) {
    value->reset();
    if (words[0] != 0) WordsOf<T>::Take(words + 1, &value->emplace());
  }
};

template <class... T>
struct WordsOf<std::variant<T...>> {
  using Variant = std::variant<T...>;
  static constexpr std::size_t kCount = 1 + std::max({WordsOf<T>::kCount...});
  static void Put(const Variant& value, PackedWord* words) {
    std::fill_n(words, kCount, 0);
    words[0] = value.index();
    std::visit([words]<class A>(const A& a) { WordsOf<A>::Put(a, words + 1); },
               value);
  }
  static void Take(const PackedWord* words, Variant* value) {
    PackedWord index = 0;
    ((index++ == words[0]
          ? WordsOf<T>::Take(words + 1, &value->template emplace<T>())
          : void()),
     ...);
  }
};

}  // namespace hindsight

#endif  // HINDSIGHT_BASE_PACKED_WORDS_H_
