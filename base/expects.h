#pragma once
/// Programmer errors only (house style 21): alive in every build type, they stop the program with file and line.
/// Bad user data is a ConfigError, physics that did not work is a field of the result or a WorkError.
namespace venato::detail {
[[noreturn]] void contract_failed(const char* kind, const char* condition, const char* file, int line);
}
#define VENATO_EXPECTS(condition) ((condition) ? void(0) : ::venato::detail::contract_failed("precondition", #condition, __FILE__, __LINE__))
#define VENATO_ENSURES(condition) ((condition) ? void(0) : ::venato::detail::contract_failed("postcondition", #condition, __FILE__, __LINE__))
