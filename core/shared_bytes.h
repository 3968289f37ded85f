#pragma once
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

namespace volgi {

/// Bytes that copies share until one of them is edited: pictures of a scene, which there is one of at each time.
class SharedBytes {
 public:
  using Bytes = std::vector<std::uint8_t>;

  SharedBytes() = default;
  SharedBytes(Bytes bytes) : bytes_(std::make_shared<Bytes>(std::move(bytes))) {}  // NOLINT: as a vector is given
  SharedBytes(std::initializer_list<std::uint8_t> bytes) : SharedBytes(Bytes(bytes)) {}

  const Bytes& bytes() const {
    static const Bytes none;
    return bytes_ ? *bytes_ : none;
  }
  size_t size() const { return bytes().size(); }
  const std::uint8_t* data() const { return bytes().data(); }
  const std::uint8_t& operator[](size_t i) const { return (*bytes_)[i]; }
  bool operator==(const SharedBytes& o) const { return bytes_ == o.bytes_ || bytes() == o.bytes(); }

  /// To be written to: this one's alone from here on. Not while others are copied on other threads.
  Bytes& edit() {
    if (!bytes_) bytes_ = std::make_shared<Bytes>();
    if (bytes_.use_count() > 1) bytes_ = std::make_shared<Bytes>(*bytes_);
    return *bytes_;
  }

 private:
  std::shared_ptr<Bytes> bytes_;
};

}  // namespace volgi
