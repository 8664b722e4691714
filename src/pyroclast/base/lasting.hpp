#pragma once

/// Attribute of a function that returns a reference to something that outlives the arguments. Without the
/// attribute, GCC from 14 on warns of a dangling reference where an argument is a temporary. Other compilers
/// do not know the attribute.
#if __has_cpp_attribute(gnu::no_dangling)
#define PYROCLAST_LASTING [[gnu::no_dangling]]
#else
#define PYROCLAST_LASTING
#endif
