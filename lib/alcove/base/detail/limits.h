/// The process-wide limits on memory and on reading. Set them before other calls, as they apply to all threads.
#pragma once

namespace alcove {

/// Bytes that level sets and images may take, including the memory needed to build them. By default half of the memory
/// of the machine, or half of the limit of its control group (cgroup v2) if that is less.
double memory_limit();
void limit_memory(double bytes);

/// Bytes that may be read from one file or pipe. By default half of memory_limit(), because a mesh takes about twice as
/// much memory as its file, but at most 4 GB.
double read_limit();
void limit_reading(double bytes);

}
