#pragma once

/// Before a function that returns a reference to what lives on when its arguments are gone. GCC from 14 on
/// would else warn of a reference that dangles, where an argument is a temporary. Other compilers do not know
/// the attribute.
#if __has_cpp_attribute(gnu::no_dangling)
#define PYROCLAST_LASTING [[gnu::no_dangling]]
#else
#define PYROCLAST_LASTING
#endif
