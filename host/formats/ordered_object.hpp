// The members of a JSON object in the order in which they came, each found in logarithmic time.
//
// The library's own ordered object looks through all of its members for one: to read n of them takes n^2
// steps, and whoever makes a file chooses n.
#pragma once

#include <cstddef>
#include <functional>
#include <iterator>
#include <list>
#include <map>
#include <memory>
#include <string_view>
#include <tuple>
#include <utility>

namespace gyrolog {

// An object as nlohmann::basic_json wants it; `Key` is its text. Members do not move, so the index refers to
// them.
template <class Key, class Value, class /*Less*/ = std::less<>,
          class Allocator = std::allocator<std::pair<const Key, Value>>>
class OrderedObject {
    using Members = std::list<std::pair<const Key, Value>, Allocator>;

public:
    using key_type = Key;
    using mapped_type = Value;
    using value_type = typename Members::value_type;
    using allocator_type = Allocator;
    using key_compare = std::less<>;
    using size_type = typename Members::size_type;
    using difference_type = typename Members::difference_type;
    using reference = value_type&;
    using const_reference = const value_type&;
    using iterator = typename Members::iterator;
    using const_iterator = typename Members::const_iterator;

    OrderedObject() = default;
    template <class It>
    OrderedObject(It first, It last) {
        insert(first, last);
    }
    OrderedObject(const OrderedObject& other) : OrderedObject(other.begin(), other.end()) {}
    OrderedObject(OrderedObject&& other) noexcept = default;
    OrderedObject& operator=(OrderedObject other) noexcept {
        members_.swap(other.members_);
        index_.swap(other.index_);
        return *this;
    }
    ~OrderedObject() = default;

    iterator begin() { return members_.begin(); }
    iterator end() { return members_.end(); }
    const_iterator begin() const { return members_.begin(); }
    const_iterator end() const { return members_.end(); }
    const_iterator cbegin() const { return members_.begin(); }
    const_iterator cend() const { return members_.end(); }
    bool empty() const { return members_.empty(); }
    size_type size() const { return members_.size(); }
    size_type max_size() const { return members_.max_size(); }

    iterator find(std::string_view key) {
        const auto found = index_.find(key);
        return found == index_.end() ? end() : found->second;
    }
    const_iterator find(std::string_view key) const {
        const auto found = index_.find(key);
        return found == index_.end() ? end() : const_iterator(found->second);
    }
    size_type count(std::string_view key) const { return index_.count(key); }

    // A key that is there keeps its value; whether it was not.
    template <class Text, class... Arguments>
    std::pair<iterator, bool> emplace(Text&& key, Arguments&&... value) {
        const auto place = index_.lower_bound(std::string_view(key));
        if (place != index_.end() && place->first == std::string_view(key)) { return {place->second, false}; }
        members_.emplace_back(std::piecewise_construct, std::forward_as_tuple(std::forward<Text>(key)),
                              std::forward_as_tuple(std::forward<Arguments>(value)...));
        const iterator added = std::prev(members_.end());
        index_.emplace_hint(place, added->first, added);
        return {added, true};
    }
    template <class Text>
    Value& operator[](Text&& key) {
        return emplace(std::forward<Text>(key)).first->second;
    }
    std::pair<iterator, bool> insert(const value_type& member) {
        return emplace(member.first, member.second);
    }
    std::pair<iterator, bool> insert(value_type&& member) {
        return emplace(member.first, std::move(member.second));
    }
    template <class It>
    void insert(It first, It last) {
        for (; first != last; ++first) { emplace(first->first, first->second); }
    }

    iterator erase(const_iterator at) {
        index_.erase(at->first);
        return members_.erase(at);
    }
    iterator erase(const_iterator first, const_iterator last) {
        for (const_iterator at = first; at != last; ++at) { index_.erase(at->first); }
        return members_.erase(first, last);
    }
    void clear() {
        index_.clear();
        members_.clear();
    }

    friend bool operator==(const OrderedObject& a, const OrderedObject& b) {
        return a.members_ == b.members_;
    }
    friend bool operator<(const OrderedObject& a, const OrderedObject& b) { return a.members_ < b.members_; }

private:
    Members members_;
    std::map<std::string_view, iterator> index_;  // by the members' own keys
};

}  // namespace gyrolog
