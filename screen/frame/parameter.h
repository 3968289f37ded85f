#pragma once
#include <optional>
#include <span>
#include <string>
#include <type_traits>

#include "screen/frame/type_map.h"

namespace volgi::screen {

/// A number that a technique can be given (--set NAME=VALUE), said once: everything else about it, its default too, is
/// read from the options struct that it is a member of. Enums go by the names of their values, or by their numbers.
struct Parameter {
  const char* name;  // technique, then what: "shadow.spot"
  const char* unit;  // "texels"; empty: none
  const char* help;
  double least, most;
  std::span<const char* const> value_names;  // of an enum from 0, or of a bool: off, on
  const char* when_unset;                    // of an optional member: what is done then; else null
  const char* flag;                          // an option of its own on the command line, with its dashes; null: none
  /// @param value  within [least, most], whole for integers and enums.
  void (*set)(TypeMap& options, double value);
  /// None where an optional member is not set.
  std::optional<double> (*get)(const TypeMap& options);
  /// Gives `to` what `from` has, set or not.
  void (*copy)(const TypeMap& from, TypeMap& to);
  bool whole;  // takes whole numbers only
};

/// @throws Error(usage) naming `text`, the range and the names, for what `p` does not take.
double parse_value(const Parameter& p, const std::string& text, const std::string& shown_as);
/// As it would be given, a number or a name; when_unset where it is not set.
std::string value_text(const Parameter& p, const TypeMap& options);
/// One line: name, range or names, default of a TypeMap that nobody has set, help.
std::string help_line(const Parameter& p);
std::string help_text(const Parameter& p);  // the same without the name

inline constexpr const char* OFF_ON[] = {"off", "on"};

struct ParameterText {
  const char* name;
  const char* unit;
  const char* help;
  const char* when_unset = nullptr;
  const char* flag = nullptr;
};
struct ParameterRange {
  double least = 0.0, most = 0.0;
};

namespace detail {

template <class T>
struct Unwrapped {
  using Type = T;
  static constexpr bool optional = false;
};
template <class T>
struct Unwrapped<std::optional<T>> {
  using Type = T;
  static constexpr bool optional = true;
};

}  // namespace detail

/// The last argument is [](Options& o) -> auto& { return o.member; }, of a member of a struct that TypeMap keeps.
template <class Options, class Member>
constexpr Parameter parameter(ParameterText text, ParameterRange range, std::span<const char* const> names,
                              Member /*member*/) {
  using Stored = std::remove_reference_t<std::invoke_result_t<Member, Options&>>;
  using Value = typename detail::Unwrapped<Stored>::Type;
  const auto set = [](TypeMap& options, double value) { Member{}(options.of<Options>()) = static_cast<Value>(value); };
  const auto get = [](const TypeMap& options) -> std::optional<double> {
    Options copy = options.of<Options>();
    const Stored& stored = Member{}(copy);
    if constexpr (detail::Unwrapped<Stored>::optional) {
      if (!stored) return std::nullopt;
      return static_cast<double>(*stored);
    } else {
      return static_cast<double>(stored);
    }
  };
  const auto copy = [](const TypeMap& from, TypeMap& to) {
    Options value = from.of<Options>();
    Member{}(to.of<Options>()) = Member{}(value);
  };
  return {text.name,       text.unit, text.help, range.least, range.most, names,
          text.when_unset, text.flag, set,       get,         copy,       !std::is_floating_point_v<Value>};
}

/// A number. @param range  both ends included.
template <class Options, class Member>
constexpr Parameter number(ParameterText text, ParameterRange range, Member member) {
  return parameter<Options>(text, range, {}, member);
}
/// An enum from 0 with a name for each value.
template <class Options, size_t N, class Member>
constexpr Parameter choice(ParameterText text, const char* const (&names)[N], Member member) {
  return parameter<Options>(text, {0.0, double(N - 1)}, names, member);
}
template <class Options, class Member>
constexpr Parameter yes_no(ParameterText text, Member member) {
  return parameter<Options>(text, {0.0, 1.0}, OFF_ON, member);
}

}  // namespace volgi::screen
