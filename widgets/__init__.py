"""The panels of the editor. Panels are independent of each other and share only `common`; the shell connects them."""
