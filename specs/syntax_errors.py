x=1
def explain_syntax_error(found, run, prepared):
    raise found
