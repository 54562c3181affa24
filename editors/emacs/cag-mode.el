;;; cag-mode.el --- Scripts of the cag language -*- lexical-binding: t -*-

;; Version: 0.1.0
;; Package-Requires: ((emacs "26.1"))

;;; Commentary:

;; A major mode for scripts of cag, and the language server for Eglot.

;;; Code:

(defvar cag-mode-syntax-table
  (let ((table (make-syntax-table)))
    (modify-syntax-entry ?/ ". 124b" table)
    (modify-syntax-entry ?* ". 23n" table)
    (modify-syntax-entry ?\n "> b" table)
    (modify-syntax-entry ?` "\"" table)
    (modify-syntax-entry ?' "." table)
    (modify-syntax-entry ?_ "_" table)
    table))

(defvar cag-mode-font-lock-keywords
  (list
   (cons (regexp-opt '("and" "as" "assert" "by" "else" "for" "if" "import" "in" "not" "or" "param" "print" "show" "then") 'symbols)
         'font-lock-keyword-face)
   (cons (regexp-opt '("true" "false" "none") 'symbols) 'font-lock-constant-face)
   '("^\\(?:param +\\)?\\([[:alpha:]_][[:alnum:]_]*\\)\\(?:([^\n]*)\\)? *=" 1 font-lock-function-name-face)))

;;;###autoload
(define-derived-mode cag-mode prog-mode "cag"
  "Major mode for scripts of the cag language."
  (setq-local comment-start "// ")
  (setq-local comment-end "")
  (setq-local comment-start-skip "//+ *")
  (setq-local indent-tabs-mode nil)
  (setq-local tab-width 2)
  (setq-local fill-column 100)
  (setq-local indent-line-function #'indent-relative)
  (setq-local font-lock-defaults '(cag-mode-font-lock-keywords)))

;;;###autoload
(add-to-list 'auto-mode-alist '("\\.cag\\'" . cag-mode))

(defvar eglot-server-programs)
(with-eval-after-load 'eglot
  (add-to-list 'eglot-server-programs '(cag-mode . ("cag" "lsp"))))

(provide 'cag-mode)
;;; cag-mode.el ends here
