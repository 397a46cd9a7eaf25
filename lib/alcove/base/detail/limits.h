/// Limits of the process on memory and on reading. Set them before other calls, as they apply to all threads.
#pragma once

namespace alcove {

/// Bytes that level sets and images may take, including the memory needed to build them. By default half of the
/// memory of the machine, or of the control group (cgroup v2) if that has less.
double memory_limit();
void limit_memory(double bytes);

/// Bytes that may be read from one file or pipe. By default half of memory_limit(), since a mesh takes about twice the
/// size of its file, but at most 4 GB.
double read_limit();
void limit_reading(double bytes);

}
