#pragma once
#include <algorithm>
#include <cstddef>
#include <memory>
#include <type_traits>
#include <utility>

namespace venato::dem {

/// Array of plain data without initialisation that keeps its memory: what is resized at every list build and written before it is read.
template <class T>
class RawArray {
  static_assert(std::is_trivially_destructible_v<T>);

 public:
  void resize_for_overwrite(std::size_t n) {
    if (n > capacity_) data_ = std::make_unique_for_overwrite<T[]>(capacity_ = n + n / 8);
    size_ = n;
  }
  /// Makes room for n, keeping what is there.
  void grow(std::size_t n) {
    if (n > capacity_) {
      std::unique_ptr<T[]> larger = std::make_unique_for_overwrite<T[]>(n);
      std::copy_n(data_.get(), size_, larger.get());
      data_ = std::move(larger), capacity_ = n;
    }
    size_ = n;
  }
  std::size_t size() const { return size_; }
  std::size_t capacity() const { return capacity_; }
  T* data() { return data_.get(); }
  const T* data() const { return data_.get(); }
  T& operator[](std::size_t k) { return data_[k]; }
  const T& operator[](std::size_t k) const { return data_[k]; }

 private:
  std::unique_ptr<T[]> data_;
  std::size_t size_ = 0, capacity_ = 0;
};
}  // namespace venato::dem
