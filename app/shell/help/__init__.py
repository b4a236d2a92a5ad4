"""The guides of ``docs``, read inside the program: F1, the Help menu and the help buttons of dialogs open them."""
