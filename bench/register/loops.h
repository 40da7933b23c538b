// The figures of registration that need dips.
#pragma once

namespace hydrodip {

// Two corrections of a print whose film model is wrong.
void closed_loop();

// Designed for film that has swollen, dipped as such film on a finer grid that knows nothing of
// swelling.
void swollen_film();

}  // namespace hydrodip
