// Large arrays of zeros that take memory only where something is written: most of a sheet stays
// blank.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <initializer_list>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>

namespace hydrodip {

// Of fixed size. The system's pages of zeros stand for whatever was never written, however large it
// is; so making one takes no time either.
template <typename T>
class BlankArray {
  static_assert(std::is_trivial_v<T>);

 public:
  using value_type = T;

  BlankArray() = default;
  // All zero. Throws std::bad_alloc.
  explicit BlankArray(std::size_t size)
      : values_(size > 0 ? static_cast<T*>(std::calloc(size, sizeof(T))) : nullptr), size_(size) {
    if (size > 0 && !values_) throw std::bad_alloc();
  }
  BlankArray(std::initializer_list<T> values) : BlankArray(values.size()) {
    std::copy(values.begin(), values.end(), begin());
  }
  BlankArray(const BlankArray& other) : BlankArray(other.size_) {
    std::copy(other.begin(), other.end(), begin());
  }
  BlankArray(BlankArray&& other) noexcept
      : values_(std::move(other.values_)), size_(std::exchange(other.size_, 0)) {}
  BlankArray& operator=(BlankArray other) noexcept {
    std::swap(values_, other.values_);
    std::swap(size_, other.size_);
    return *this;
  }

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  T* data() { return values_.get(); }
  const T* data() const { return values_.get(); }
  T& operator[](std::size_t i) { return values_.get()[i]; }
  const T& operator[](std::size_t i) const { return values_.get()[i]; }
  T* begin() { return data(); }
  T* end() { return data() + size_; }
  const T* begin() const { return data(); }
  const T* end() const { return data() + size_; }

  friend bool operator==(const BlankArray& a, const BlankArray& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
  }

 private:
  struct Free {
    void operator()(T* values) const { std::free(values); }
  };
  std::unique_ptr<T, Free> values_;
  std::size_t size_ = 0;
};

// Gives whole pages back to the system, which makes new ones of zeros once they are looked at. What
// was there is lost: some of it stays and the rest is zero.
void give_back(void* begin, std::size_t bytes);

}  // namespace hydrodip
