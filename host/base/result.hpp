// A failed operation is a value. Bad data from outside is counted by its decoder and is no error; our own
// bugs abort.
#pragma once

#include <cassert>
#include <cstdlib>
#include <optional>
#include <string>
#include <utility>

namespace gyrolog {

enum class ErrorCode {
    invalid_argument,   // the request makes no sense; retrying cannot help
    not_found,          // the file or device is not there
    permission_denied,  // it is there, and we may not
    busy,               // somebody else holds it
    device_lost,        // it was there, and went away
    storage_failed,     // the disk refused; what was synced before is still safe
    disk_full,          // no space, or less than the caller wants kept free
    malformed,          // bytes from outside break their specification
    unsupported,        // well formed, but of a version or kind this build does not know
    timeout,            // nothing came in the time allowed
    failed,             // the operation could not be done; the message says why
};

struct Error {
    ErrorCode code;
    std::string
        message;  // one lower-case clause that names the thing that failed and, where there is one, the mend
};

inline Error invalid_argument(std::string message) {
    return {ErrorCode::invalid_argument, std::move(message)};
}
inline Error malformed(std::string message) { return {ErrorCode::malformed, std::move(message)}; }

// Either a value or an Error. Reading the one that is not there is our own bug and aborts, in a release build
// too: the value may be read only after ok() was seen true, the error only after it was seen false.
template <typename T>
class [[nodiscard]] Result {
public:
    Result(T value) : value_(std::move(value)) {}      // NOLINT(google-explicit-constructor)
    Result(Error error) : error_(std::move(error)) {}  // NOLINT(google-explicit-constructor)

    bool ok() const { return value_.has_value(); }
    explicit operator bool() const { return ok(); }

    T& value() & {
        abort_unless(ok());
        return *value_;
    }
    const T& value() const& {
        abort_unless(ok());
        return *value_;
    }
    T&& value() && { return std::move(value()); }
    T* operator->() { return &value(); }
    const T* operator->() const { return &value(); }
    T& operator*() & { return value(); }
    const T& operator*() const& { return value(); }
    T&& operator*() && { return std::move(value()); }

    const Error& error() const& {
        abort_unless(!ok());
        return error_;
    }
    Error&& error() && {
        abort_unless(!ok());
        return std::move(error_);
    }

private:
    static void abort_unless(bool it_is_there) {
        if (!it_is_there) { std::abort(); }
    }

    // Not a variant: the compiler takes much longer for one, and there are hundreds.
    std::optional<T> value_;
    Error error_{ErrorCode::failed, {}};
};

template <>
class [[nodiscard]] Result<void> {
public:
    Result() = default;
    Result(Error error) : failed_(true), error_(std::move(error)) {}  // NOLINT(google-explicit-constructor)

    bool ok() const { return !failed_; }
    explicit operator bool() const { return ok(); }
    const Error& error() const& {
        assert(failed_);
        return error_;
    }
    Error&& error() && {
        assert(failed_);
        return std::move(error_);
    }

private:
    bool failed_ = false;
    Error error_{ErrorCode::failed, {}};
};

using Status = Result<void>;

// The same error, with what was being done put in front: "read capture 'a.pcapng': no such file".
inline Error in_context(std::string context, Error error) {
    error.message = std::move(context) + ": " + error.message;
    return error;
}

}  // namespace gyrolog

// NOLINTBEGIN(bugprone-macro-parentheses): a declaration cannot stand in parentheses
#define GYROLOG_CONCAT_INNER(a, b) a##b
#define GYROLOG_CONCAT(a, b) GYROLOG_CONCAT_INNER(a, b)

// GYROLOG_TRY(auto x, f()): x holds f()'s value, or the enclosing function returns its error.
#define GYROLOG_TRY(declaration, expression) \
    GYROLOG_TRY_INNER(declaration, expression, GYROLOG_CONCAT(gyrolog_try_, __LINE__))
#define GYROLOG_TRY_INNER(declaration, expression, holder)  \
    auto holder = (expression);                             \
    if (!holder.ok()) { return std::move(holder).error(); } \
    declaration = std::move(holder).value()

// NOLINTEND(bugprone-macro-parentheses)

// GYROLOG_CHECK(f()): the enclosing function returns f()'s error, if it has one.
#define GYROLOG_CHECK(expression)                                       \
    do {                                                                \
        if (auto gyrolog_status = (expression); !gyrolog_status.ok()) { \
            return std::move(gyrolog_status).error();                   \
        }                                                               \
    } while (false)
