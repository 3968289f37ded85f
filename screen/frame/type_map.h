#pragma once
#include <any>
#include <map>
#include <typeindex>

namespace volgi::screen {

/// At most one value of each type, so that a leaf can keep values of its own types among everybody's without anybody
/// else naming them: options of techniques (FrameOptions), and what they report (FrameReport).
class TypeMap {
 public:
  /// Made by its default constructor when it is asked for first.
  template <class T>
  T& of() {
    std::any& value = values_[typeid(T)];
    if (!value.has_value()) value = T();
    return *std::any_cast<T>(&value);
  }
  /// What the default constructor makes, where nobody has set another.
  template <class T>
  const T& of() const {
    static const T unset{};
    const T* value = find<T>();
    return value != nullptr ? *value : unset;
  }
  /// Null where there is none.
  template <class T>
  const T* find() const {
    const auto found = values_.find(typeid(T));
    return found == values_.end() ? nullptr : std::any_cast<T>(&found->second);
  }

 private:
  std::map<std::type_index, std::any> values_;
};

}  // namespace volgi::screen
