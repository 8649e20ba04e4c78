#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace easydyn::soil {

/// Checksum of a stream of bytes, the same however the stream is cut. Each word w of eight bytes turns the value h
/// into ((h ^ w) p) ^ (((h ^ w) p) >> 32), p odd: one to one in w and in h, so that damage within one word never
/// goes unseen, and other damage with a chance of 2^-64. No protection against intent.
class Checksum {
 public:
  void add(const void* data, std::size_t bytes) {
    const char* from = static_cast<const char*>(data);
    for (; bytes > 0 && filled_ > 0; --bytes) add_byte(*from++);
    for (; bytes >= sizeof word_; bytes -= sizeof word_, from += sizeof word_) {
      std::memcpy(&word_, from, sizeof word_);
      mix();
    }
    for (; bytes > 0; --bytes) add_byte(*from++);
  }
  template <class T>
  void add_value(const T& value) {
    add(&value, sizeof value);
  }
  void add_text(std::string_view text) {
    add_value(text.size());
    add(text.data(), text.size());
  }

  /// Of what has been added so far.
  std::uint64_t value() const {
    Checksum end = *this;
    std::memset(reinterpret_cast<char*>(&end.word_) + filled_, 0, sizeof word_ - filled_);
    end.mix();
    end.word_ = length_ + filled_;  // zeros at the end count
    end.mix();
    return end.value_;
  }

 private:
  void add_byte(char byte) {
    std::memcpy(reinterpret_cast<char*>(&word_) + filled_, &byte, 1);
    if (++filled_ == sizeof word_) mix();
  }
  void mix() {
    value_ = (value_ ^ word_) * 0x9e3779b97f4a7c15u;
    value_ ^= value_ >> 32;
    length_ += sizeof word_;
    filled_ = 0;
  }

  std::uint64_t value_ = 0, word_ = 0, length_ = 0;
  std::size_t filled_ = 0;  // bytes of word_
};

}  // namespace easydyn::soil
