//! Renderings against closed forms and an independent z-buffer.
