/// The memory that a scene needs, estimated before it is built.
#pragma once

#include <map>
#include <string>

namespace alcove {

class MemoryEstimate {
  public:
    /// `limit` in bytes.
    explicit MemoryEstimate(double limit) : limit_(limit) {}

    /// Adds `bytes` to the memory that `file` needs.
    void add(const std::string& file, double bytes);
    double limit() const { return limit_; }
    double left() const { return limit_ - total_; }
    /// \throw LimitError if nothing is left. The message names the file that needs most.
    void check() const;
    /// \throw LimitError as check().
    [[noreturn]] void refuse() const;

  private:
    double limit_, total_ = 0.0;
    std::map<std::string, double> by_file_;
};

}
