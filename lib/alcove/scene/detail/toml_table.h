/// A table of a TOML file, read strictly: what nobody asks for is an error.
#pragma once

#include "alcove/base/types.h"

#include <toml++/toml.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace alcove {

/// Every reader returns nothing where the key is not there, and throws an InputError that names the file, the line
/// and the mend where its value is of another kind. Keeps a reference to the table.
class TomlTable {
  public:
    /// `path` is what keys within it are written after, such as `object` of `[[object.part]]`.
    TomlTable(const toml::table& table, std::string file, std::string name, std::string path = {});

    std::optional<double> number(std::string_view key);   ///< finite
    std::optional<double> positive(std::string_view key); ///< finite, > 0
    std::optional<int> count(std::string_view key, int least, int most);
    std::optional<bool> flag(std::string_view key);
    std::optional<std::string> text(std::string_view key);
    /// One of the words. \throw InputError that names them all.
    std::optional<std::size_t> word(std::string_view key, std::initializer_list<std::string_view> words);
    std::optional<Vec3d> vector(std::string_view key);    ///< three finite numbers
    std::optional<Vec3d> direction(std::string_view key); ///< of any length but 0
    /// Of three numbers, or one for all, from 0 to `most`.
    std::optional<Vec3> color(std::string_view key, double most);
    std::optional<TomlTable> table(std::string_view key);
    std::vector<TomlTable>
    tables(std::string_view key); ///< of an array of tables; none where it is not there
    /// The tables within this one, by their names; all its keys must be such.
    std::vector<std::pair<std::string, TomlTable>> named_tables();

    const toml::table& raw() const { return table_; }
    bool has(std::string_view key) const { return table_.contains(key); }
    const std::string& name() const { return name_; }

    /// \throw InputError for the first key that no reader asked for, naming the nearest that one did.
    void check_all_read() const;

    /// An InputError that says `what`, at the line of the key or, without one, of the table.
    [[noreturn]] void fail(std::string_view key, const std::string& what,
                           std::string_view between = " ") const;

  private:
    const toml::node* find(std::string_view key);
    std::string path_of(std::string_view key) const;

    const toml::table& table_;
    std::string file_, name_, path_;
    std::vector<std::string> asked_;
};

}
